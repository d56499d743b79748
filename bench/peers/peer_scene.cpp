#include "bench/peers/peer_scene.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace ensemble::peers {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::ifstream open(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  return file;
}

template <class T>
std::vector<T> readArray(std::ifstream& file, std::size_t count) {
  std::vector<T> values(count);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
  if (!file) throw std::runtime_error("a file of the scene is too short; export it again");
  return values;
}

PeerMesh readMesh(const fs::path& folder, const Json& json) {
  PeerMesh mesh;
  mesh.vertex_count = json.at("vertices");
  std::ifstream file = open(folder / json.at("file").get<std::string>());
  mesh.positions = readArray<float>(file, mesh.vertex_count * 3);
  mesh.normals = readArray<float>(file, mesh.vertex_count * 3);
  mesh.weights = readArray<float>(file, mesh.vertex_count * 4);
  mesh.joints = readArray<std::uint8_t>(file, mesh.vertex_count * 4);
  mesh.indices = readArray<std::uint32_t>(file, json.at("triangles").get<std::size_t>() * 3);
  return mesh;
}

PeerClip readClip(const fs::path& folder, const Json& json) {
  PeerClip clip;
  clip.key_count = json.at("keys");
  clip.joint_count = json.at("joints");
  clip.seconds = json.at("seconds");
  std::ifstream file = open(folder / json.at("file").get<std::string>());
  clip.matrices = readArray<float>(file, clip.key_count * clip.joint_count * 12);
  return clip;
}

std::vector<std::string_view> fieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t comma; (comma = line.find(',')) != line.npos; line.remove_prefix(comma + 1)) {
    fields.push_back(line.substr(0, comma));
  }
  fields.push_back(line);
  return fields;
}

std::vector<PeerPerson> readCrowd(const fs::path& path, std::size_t count) {
  std::ifstream file = open(path);
  std::string line;
  std::getline(file, line);
  std::map<std::string, std::size_t, std::less<>> column;
  for (const std::string_view name : fieldsOf(line)) column.emplace(name, column.size());
  std::vector<PeerPerson> people;
  while (people.size() < count && std::getline(file, line)) {
    const std::vector<std::string_view> fields = fieldsOf(line);
    const auto number = [&](std::string_view name) {
      const std::string_view field = fields.at(column.at(std::string(name)));
      float value = 0.0f;
      if (std::from_chars(field.data(), field.data() + field.size(), value).ec != std::errc()) {
        throw std::runtime_error(path.string() + ": '" + std::string(field) + "' is no number");
      }
      return value;
    };
    people.push_back({number("x"), number("z"), number("heading"), number("phase")});
  }
  if (people.size() < count) throw std::runtime_error(path.string() + " holds too few people");
  return people;
}

Triple towards(Triple direction) {
  const float length = std::hypot(direction[0], direction[1], direction[2]);
  for (float& part : direction) part /= -length;
  return direction;
}

void readView(const Json& views, const PeerChoice& choice, PeerScene& scene) {
  for (const Json& view : views) {
    if (view.at("name") != choice.view || view.at("characters") != choice.characters) continue;
    scene.camera = view.at("position");
    scene.target = view.at("target");
    scene.fov_y_degrees = view.at("fov_y");
    scene.near_plane = view.at("near");
    scene.far_plane = view.at("far");
    return;
  }
  throw std::runtime_error("the scene has no view '" + choice.view + "' of " +
                           std::to_string(choice.characters) + " people");
}

}  // namespace

PeerScene readPeerScene(const PeerChoice& choice) {
  std::ifstream file = open(choice.folder / "scene.json");
  const Json json = Json::parse(file);
  PeerScene scene;
  scene.width = json.at("width");
  scene.height = json.at("height");
  const Json& light = json.at("light");
  scene.to_light = towards(light.at("direction"));
  scene.sun = light.at("sun");
  scene.ambient_up = light.at("ambient_up");
  scene.ambient_down = light.at("ambient_down");
  scene.colour = json.at("colour");
  readView(json.at("views"), choice, scene);
  scene.mesh = readMesh(choice.folder, json.at("meshes").at(choice.order));
  scene.clip = readClip(choice.folder, json.at("poses"));
  const std::string crowd = json.at("crowds").at(choice.poses);
  scene.people = readCrowd(choice.folder / crowd, choice.characters);
  return scene;
}

}  // namespace ensemble::peers
