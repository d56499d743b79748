// A peer to measure against: OGRE 1.12 draws the exported crowd by hardware instancing, with bone matrices in
// a vertex texture (InstanceManager::HWInstancingVTF). Prints one line of JSON.
//
// Where all stand on key frames, people share poses (IM_VTFBONEMATRIXLOOKUP and shareTransformWith): the
// technique's fastest way. Interpolated, each person has a skeleton of its own, as OGRE asks for.
#include <GL/gl.h>
#include <Ogre.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/peers/ogre_person.h"

namespace ensemble::peers {
namespace {

struct Arguments {
  PeerChoice choice;
  unsigned warm = 2, frames = 5;
  std::string picture, log;
};

/// Calls what may throw out of one of OGRE's plugins. Such an exception must not outlive its plugin, nor
/// therefore the engine: another one carries its message on.
template <class Work>
void guarded(const Work& work) {
  try {
    work();
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what());
  }
}

/// OGRE's root with a hidden window, which brings the GL context along.
class Engine {
 public:
  explicit Engine(const std::string& log) {
    // Quiet: standard output is for the result.
    logs_.createLog(log, true, false, log.empty());
    root_ = std::make_unique<Ogre::Root>("", "", "");
    guarded([&] { open(); });
  }

  Ogre::Root& root() { return *root_; }
  Ogre::SceneManager& scene() { return *scene_; }

 private:
  void open() {
    root_->loadPlugin(OGRE_PLUGINS "/RenderSystem_GL3Plus");
    root_->loadPlugin(OGRE_PLUGINS "/Codec_STBI");
    root_->setRenderSystem(root_->getAvailableRenderers().front());
    root_->initialise(false);
    Ogre::NameValuePairList options = {{"hidden", "true"}, {"vsync", "false"}, {"FSAA", "0"}};
    root_->createRenderWindow("context", 16, 16, false, &options)->setAutoUpdated(false);
    scene_ = root_->createSceneManager();
  }

  Ogre::LogManager logs_;
  std::unique_ptr<Ogre::Root> root_;
  Ogre::SceneManager* scene_ = nullptr;
};

Ogre::RenderTarget* makeTarget(const PeerScene& scene, Ogre::SceneManager& manager) {
  Ogre::Camera* camera = manager.createCamera("camera");
  camera->setNearClipDistance(scene.near_plane);
  camera->setFarClipDistance(scene.far_plane);
  camera->setFOVy(Ogre::Degree(scene.fov_y_degrees));
  camera->setAspectRatio(static_cast<float>(scene.width) / static_cast<float>(scene.height));
  Ogre::SceneNode* node = manager.getRootSceneNode()->createChildSceneNode();
  node->attachObject(camera);
  node->setPosition(scene.camera[0], scene.camera[1], scene.camera[2]);
  node->lookAt({scene.target[0], scene.target[1], scene.target[2]}, Ogre::Node::TS_WORLD);

  Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      "picture", kGroup, Ogre::TEX_TYPE_2D, scene.width, scene.height, 0, Ogre::PF_BYTE_RGBA,
      Ogre::TU_RENDERTARGET);
  Ogre::RenderTarget* target = texture->getBuffer()->getRenderTarget();
  Ogre::Viewport* viewport = target->addViewport(camera);
  viewport->setBackgroundColour(Ogre::ColourValue(0, 0, 0, 0));
  viewport->setOverlaysEnabled(false);
  viewport->setSkiesEnabled(false);
  viewport->setShadowsEnabled(false);
  return target;
}

/// The crowd's instances and what moves them.
class Crowd {
 public:
  Crowd(const PeerScene& scene, Ogre::SceneManager& manager, bool shares_poses)
      : scene_(scene), key_intervals_(scene.clip.key_count - 1) {
    const std::size_t count = scene.people.size();
    const auto flags = static_cast<Ogre::uint16>(shares_poses ? Ogre::IM_VTFBONEMATRIXLOOKUP : 0);
    Ogre::InstanceManager* instances = manager.createInstanceManager(
        "crowd", kPersonMesh, kGroup, Ogre::InstanceManager::HWInstancingVTF, count, flags);
    if (shares_poses) instances->setMaxLookupTableInstances(std::min(count, key_intervals_));
    for (std::size_t i = 0; i < count; ++i) place(*instances->createInstancedEntity(kPersonMaterial), i);
    if (shares_poses) {
      sharePoses();
    } else {
      for (std::size_t i = 0; i < count; ++i) addMover(*people_[i], scene.people[i].phase);
    }
  }

  /// @param key time in key intervals
  void setTime(double key) {
    const double intervals = static_cast<double>(key_intervals_);
    for (const Mover& mover : movers_) {
      const double phase = std::fmod(mover.phase + key / intervals, 1.0);
      mover.state->setTimePosition(static_cast<float>(phase) * scene_.clip.seconds);
    }
  }

 private:
  struct Mover {
    Ogre::AnimationState* state;
    double phase;
  };

  void place(Ogre::InstancedEntity& entity, std::size_t i) {
    const PeerPerson& person = scene_.people[i];
    entity.setPosition({person.x, 0.0f, person.z}, false);
    entity.setOrientation(Ogre::Quaternion(Ogre::Degree(person.heading_degrees), Ogre::Vector3::UNIT_Y));
    people_.push_back(&entity);
  }

  void addMover(Ogre::InstancedEntity& entity, double phase) {
    Ogre::AnimationState* state = entity.getAnimationState(kPersonClip);
    state->setEnabled(true);
    state->setLoop(true);
    movers_.push_back({state, phase});
  }

  // The first person on each key is posed, the others on it share that pose.
  void sharePoses() {
    std::vector<Ogre::InstancedEntity*> first(key_intervals_);
    const auto keyOf = [&](std::size_t i) {
      const double key = scene_.people[i].phase * static_cast<double>(key_intervals_);
      return static_cast<std::size_t>(std::lround(key)) % key_intervals_;
    };
    for (std::size_t i = 0; i < people_.size(); ++i) {
      Ogre::InstancedEntity*& master = first[keyOf(i)];
      if (master != nullptr) continue;
      master = people_[i];
      master->stopSharingTransform();
    }
    for (std::size_t i = 0; i < people_.size(); ++i) {
      Ogre::InstancedEntity* master = first[keyOf(i)];
      if (master != people_[i]) master->shareTransformWith(people_[i]);
    }
    for (std::size_t key = 0; key < key_intervals_; ++key) {
      if (first[key] == nullptr) continue;
      addMover(*first[key], static_cast<double>(key) / static_cast<double>(key_intervals_));
    }
  }

  const PeerScene& scene_;
  std::size_t key_intervals_;
  std::vector<Ogre::InstancedEntity*> people_;
  std::vector<Mover> movers_;
};

/// Each frame is one key interval later than the one before, so that all poses change.
double drawFrame(Engine& engine, Crowd& crowd, unsigned frame) {
  const auto begin = std::chrono::steady_clock::now();
  crowd.setTime(frame);
  engine.root().renderOneFrame();
  glFinish();
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  return taken.count();
}

void measure(const Arguments& arguments, const PeerScene& scene, Engine& engine) {
  const bool shares_poses = arguments.choice.poses == "keys";
  Ogre::RenderTarget* target = makeTarget(scene, engine.scene());
  makeOgrePerson(scene);
  makeOgreMaterial(scene, shares_poses);
  Crowd crowd(scene, engine.scene(), shares_poses);

  drawFrame(engine, crowd, 0);
  if (!arguments.picture.empty()) target->writeContentsToFile(arguments.picture);
  for (unsigned i = 0; i < arguments.warm; ++i) drawFrame(engine, crowd, 1 + i);
  nlohmann::ordered_json result = {
      {"peer", "ogre"},
      {"variant", arguments.choice.order + " " + arguments.choice.poses},
      {"characters", scene.people.size()},
      {"triangles", target->getStatistics().triangleCount},
      {"device", engine.root().getRenderSystem()->getCapabilities()->getDeviceName()},
      {"frame_ms", nlohmann::json::array()}};
  for (unsigned i = 0; i < arguments.frames; ++i) {
    result["frame_ms"].push_back(drawFrame(engine, crowd, 1 + arguments.warm + i));
  }
  std::cout << result.dump() << std::endl;
}

void run(const Arguments& arguments) {
  const PeerScene scene = readPeerScene(arguments.choice);
  Engine engine(arguments.log);
  guarded([&] { measure(arguments, scene, engine); });
}

}  // namespace
}  // namespace ensemble::peers

int main(int argc, char** argv) {
  using namespace ensemble::peers;
  Arguments arguments;
  CLI::App app("Draws an exported crowd with OGRE and prints the frames' times");
  app.add_option("scene", arguments.choice.folder, "Folder that export_character.py wrote")->required();
  app.add_option("--order", arguments.choice.order)->check(CLI::IsMember({"exported", "optimised"}));
  app.add_option("--poses", arguments.choice.poses)->check(CLI::IsMember({"keys", "interpolated"}));
  app.add_option("--view", arguments.choice.view);
  app.add_option("--characters", arguments.choice.characters);
  app.add_option("--warm", arguments.warm, "Frames before the first that counts");
  app.add_option("--frames", arguments.frames, "Frames that count");
  app.add_option("--picture", arguments.picture, "PNG of the first frame");
  app.add_option("--log", arguments.log, "File for OGRE's log (default: none)");
  CLI11_PARSE(app, argc, argv);
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "ogre_crowd: " << error.what() << "\n";
    return 1;
  }
}
