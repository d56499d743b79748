// Queues, draws and poses as shaders find them against those of the host, bit by bit.
#include "renderer/device_culling.h"

#include <cstring>
#include <fstream>
#include <random>

#include "renderer/animation.h"
#include "tests/renderer/gpu_fixture.h"
#include "tests/support/stick_walker.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

/// How often people are in a queue, summed over tiles.
struct Found {
  std::size_t seen = 0, casting = 0, posed = 0, at_keys = 0, entries = 0, draws = 0;
};

/// A crowd with both ways to queue it.
class Stage {
 public:
  Stage(const Wardrobe& wardrobe, Crowd crowd, Technique technique = Technique::kTagged,
        std::uint64_t max_buffer_bytes = 128ull << 20)
      : device_({.validate = testing::hasValidationLayer()}),
        crowd_(std::move(crowd)),
        animation_(buildAnimation(std::span(&wardrobe, 1))),
        lists_(listsOf(wardrobe, crowd_, technique)),
        assets_(device_, inputOf(wardrobe)),
        host_state_(device_, crowd_, animation_, max_buffer_bytes),
        device_state_(device_, crowd_, animation_, max_buffer_bytes),
        layout_(device_, assets_),
        main_(device_, layout_, assets_, host_state_),
        shadow_(device_, layout_, assets_, host_state_) {
    if (DeviceCulling::isPossible(device_, assets_, device_state_, max_buffer_bytes))
      culling_ = std::make_unique<DeviceCulling>(device_, layout_, assets_, device_state_);
  }

  bool canCull() const { return culling_ != nullptr; }
  std::size_t itemCount() const { return assets_.items().size(); }
  const CrowdState& state() const { return host_state_; }
  std::vector<std::string> messages() const { return device_.validationMessages(); }

  void setTime(double seconds) {
    host_state_.setTime(seconds);
    device_state_.setTime(seconds);
  }

  /// Draws nothing, but queues all for a view tile by tile, both ways. @param fit null: the view's
  Found compare(const View& view, const TileLimits& tiles = {}, const ShadowFit* fit = nullptr) {
    const ShadowFit own = fit ? *fit : fitShadowMap(view, host_state_.bounds());
    const TileGrid grid(view.width, view.height, tiles);
    Found found;
    for (std::uint32_t i = 0; i < grid.count(); ++i) {
      queueOnHost(view, grid[i], own, i == 0);
      culling_->aim(view, grid[i], own, i == 0);
      device_.runOnce([&](const vk::raii::CommandBuffer& commands) {
        culling_->record(commands);
        gpu::recordBarrier(commands, vk::PipelineStageFlagBits2::eComputeShader,
                           vk::AccessFlagBits2::eShaderStorageWrite, vk::PipelineStageFlagBits2::eHost,
                           vk::AccessFlagBits2::eHostRead);
      });
      expectSameDraws(main_, culling_->main());
      if (i == 0) expectSameDraws(shadow_, culling_->shadow());
      EXPECT_EQ(culling_->peopleInPicture(), in_picture_.size());
      expectSamePoses(found);
      device_.runOnce([&](const vk::raii::CommandBuffer& commands) {
        host_state_.recordPoses(commands);
        device_state_.recordPoses(commands);
      });
      found.seen += seen_.size();
      found.draws += main_.counts().draw_calls;
      for (const QueueBuffers::Chunk& chunk : main_.chunks()) found.entries += chunk.queues.entryCount();
      if (i == 0) found.casting += casters_.size();
    }
    EXPECT_THAT(messages(), ::testing::IsEmpty());
    return found;
  }

 private:
  static SubMeshLists listsOf(const Wardrobe& wardrobe, const Crowd& crowd, Technique technique) {
    std::vector<Combination> combinations;
    for (const WornCombination& worn : crowd.combinations) combinations.push_back(worn.items);
    return buildSubMeshLists(wardrobe, combinations, technique);
  }

  CrowdAssets::Input inputOf(const Wardrobe& wardrobe) const {
    CrowdAssets::Input input;
    input.wardrobes.push_back({.lists = &lists_,
                               .file = "memory",
                               .fixed_joint = animation_.joint_count[0] - 1,
                               .region_count = static_cast<std::uint32_t>(wardrobe.body.regions.size())});
    for (std::uint32_t c = 0; c < crowd_.combinations.size(); ++c) input.combinations.emplace_back(0, c);
    return input;
  }

  /// As FrameLoop does where nobody is drawn in compute.
  void queueOnHost(const View& view, const Tile& tile, const ShadowFit& fit, bool draws_shadows) {
    const std::span<const Sphere> bounds = host_state_.bounds();
    findVisible(frustumOf(view), bounds, in_picture_);
    casters_.clear();
    if (view.light.shadows) findCasters(fit, bounds, casters_);
    const std::vector<float> edges(bounds.size(), 0.0f);
    const PeopleAtTime people{host_state_.characters(), bounds, host_state_.heights(), edges};
    shown_.choose(view, fit, host_state_.keyFrames(), people, in_picture_, casters_, 0);
    findVisible(frustumOf(view, tile), bounds, seen_);
    main_.build(assets_, host_state_, seen_);
    posed_ = host_state_.queuePoses(seen_, shown_);
    if (!draws_shadows) return;
    shadow_.build(assets_, host_state_, casters_);
    posed_ += host_state_.queuePoses(casters_, shown_);
  }

  template <class T>
  std::vector<T> read(const gpu::Buffer& buffer, std::size_t count) {
    const gpu::Buffer copy(device_, count * sizeof(T), vk::BufferUsageFlagBits::eTransferDst,
                           gpu::Buffer::Kind::kReadback, "a copy");
    if (count > 0) {
      device_.runOnce([&](const vk::raii::CommandBuffer& commands) {
        commands.copyBuffer(buffer.handle(), copy.handle(),
                            vk::BufferCopy{.srcOffset = 0, .dstOffset = 0, .size = count * sizeof(T)});
        gpu::recordBarrier(commands, vk::PipelineStageFlagBits2::eTransfer,
                           vk::AccessFlagBits2::eTransferWrite, vk::PipelineStageFlagBits2::eHost,
                           vk::AccessFlagBits2::eHostRead);
      });
    }
    const std::span<const T> values = copy.mapped<T>().first(count);
    return {values.begin(), values.end()};
  }

  template <class T>
  static bool areSame(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  }

  void expectSameDraws(const QueueBuffers& host, const DeviceQueues& shaders) {
    ASSERT_EQ(host.chunks().size(), shaders.chunks().size());
    EXPECT_EQ(shaders.counts().draw_calls, host.counts().draw_calls);
    EXPECT_EQ(shaders.counts().triangles, host.counts().triangles);
    for (std::size_t i = 0; i < host.chunks().size(); ++i) {
      const QueueBuffers::Chunk& expected = host.chunks()[i];
      const DeviceQueues::Chunk& built = shaders.chunks()[i];
      const std::span<const GpuQueueTotal> totals = shaders.scan().totals(i);
      ASSERT_EQ(totals.size(), itemCount());
      for (std::size_t s = 0; s < totals.size(); ++s) {
        ASSERT_EQ(totals[s].count, expected.queues.lengths()[s]) << "sub-mesh " << s;
        ASSERT_EQ(totals[s].offset, expected.queues.offsets()[s]) << "sub-mesh " << s;
      }
      const std::uint32_t entry_count = expected.queues.entryCount();
      const auto entries = read<std::uint32_t>(built.entries, entry_count);
      const std::span<const std::uint32_t> expected_entries =
          expected.entries.mapped<std::uint32_t>().first(entry_count);
      EXPECT_TRUE(std::equal(entries.begin(), entries.end(), expected_entries.begin()));
      expectSameCommands(expected, built, shaders.batches());
    }
  }

  /// The same batches with the same draws: the host's lie packed, the device's from where each batch begins.
  void expectSameCommands(const QueueBuffers::Chunk& host, const DeviceQueues::Chunk& shaders,
                          const std::vector<DrawBatch>& batches) {
    const auto counts = read<std::uint32_t>(shaders.draw_counts, batches.size());
    const auto commands = read<vk::DrawIndexedIndirectCommand>(shaders.commands, itemCount());
    const auto draws = read<GpuDraw>(shaders.draws, itemCount());
    std::size_t next = 0;
    for (std::size_t b = 0; b < batches.size(); ++b) {
      ASSERT_LE(counts[b], batches[b].draw_count);
      if (counts[b] == 0) continue;
      ASSERT_LT(next, host.batches.size());
      const DrawBatch& expected = host.batches[next++];
      EXPECT_EQ(batches[b].state, expected.state);
      ASSERT_EQ(counts[b], expected.draw_count);
      for (std::uint32_t d = 0; d < counts[b]; ++d) {
        const std::uint32_t from = expected.first_draw + d, at = batches[b].first_draw + d;
        EXPECT_TRUE(areSame(commands[at], host.commands.mapped<vk::DrawIndexedIndirectCommand>()[from]));
        EXPECT_TRUE(areSame(draws[at], host.draws.mapped<GpuDraw>()[from]));
      }
    }
    EXPECT_EQ(next, host.batches.size());
  }

  void expectSamePoses(Found& found) {
    EXPECT_EQ(culling_->peoplePosed(), posed_);
    found.posed += posed_;
    for (std::size_t i = 0; i < host_state_.chunks().size(); ++i) {
      const CrowdChunk &host = host_state_.chunks()[i], &shaders = device_state_.chunks()[i];
      const GpuPoseHead head = shaders.pose_head.mapped<GpuPoseHead>()[0];
      ASSERT_EQ(head.count, host.pose_queue_length);
      EXPECT_EQ(head.groups_x, head.count) << "in one row";
      EXPECT_EQ(head.groups_y, head.count > 0 ? 1u : 0u);
      EXPECT_EQ(head.groups_z, 1u);
      for (std::uint32_t job = 0; job < head.count; ++job) {
        const GpuPoseJob expected = host.pose_queue.mapped<GpuPoseJob>()[job];
        ASSERT_TRUE(areSame(shaders.pose_queue.mapped<GpuPoseJob>()[job], expected)) << "job " << job;
        found.at_keys += expected.key_matrix != 0;
      }
    }
  }

  gpu::Device device_;
  const Crowd crowd_;
  const Animation animation_;
  const SubMeshLists lists_;
  const CrowdAssets assets_;
  CrowdState host_state_, device_state_;
  const CrowdLayout layout_;
  QueueBuffers main_, shadow_;
  std::unique_ptr<DeviceCulling> culling_;
  ViewPeople shown_;
  std::vector<std::uint32_t> in_picture_, seen_, casters_;
  std::uint32_t posed_ = 0;
};

class DeviceCullingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (deviceName() == "none") GTEST_SKIP() << "there is no Vulkan device";
    const gpu::Device device({});
    if (!device.canCountDraws()) GTEST_SKIP() << "the device can't take numbers of draws from a buffer";
  }

  static Crowd crowdOf(const Scene& scene, const Wardrobe& wardrobe) {
    return populateCrowd(scene, std::span(&wardrobe, 1));
  }

  /// From among the people: a third of them is in sight; some are small.
  static View viewAmong(const Scene& scene) {
    View view = viewOf(scene);
    view.width = 640;
    view.height = 360;
    view.camera.position = Vec3(1.0f, 2.0f, 2.0f);
    view.camera.target = Vec3(-4.0f, 1.0f, -6.0f);
    view.snap_below = 60.0f;
    return view;
  }

  const Wardrobe tubes_ = testing::tubeWardrobe();
};

TEST_F(DeviceCullingTest, EqualsTheHostOverCrowdsAndCameras) {
  for (const std::uint32_t count : {1u, 5u, 127u, 128u, 129u, 1100u}) {
    Scene scene = testing::tubeScene(count);
    scene.crowd.seed = 100 + count;
    Stage stage(tubes_, crowdOf(scene, tubes_));
    ASSERT_TRUE(stage.canCull());
    View view = viewAmong(scene);
    Found among;
    for (const float turn : {0.0f, 1.1f, 2.9f, 4.2f}) {
      view.camera.target = view.camera.position + Vec3(std::cos(turn), -0.1f, std::sin(turn));
      const Found found = stage.compare(view);
      EXPECT_LE(found.seen, found.casting + count);
      among.seen += found.seen;
      among.posed += found.posed;
      among.at_keys += found.at_keys;
      stage.setTime(0.1 * static_cast<double>(turn));
    }
    if (count < 1000) continue;
    EXPECT_GT(among.seen, 400u);
    EXPECT_LT(among.seen, 4u * count - 1000u);
    EXPECT_GT(among.at_keys, 100u);
    EXPECT_GT(among.posed, among.at_keys + 100u) << "some are at key frames, others between them";
  }
}

TEST_F(DeviceCullingTest, EqualsTheHostWithEverybodyNobodyAndOneOutfit) {
  Scene scene = testing::tubeScene(600);
  scene.crowd.outfits = {{"tunic", 1.0f, {}}};
  Stage stage(tubes_, crowdOf(scene, tubes_));
  ASSERT_TRUE(stage.canCull());
  View view = viewAmong(scene);
  view.camera.position = Vec3(0.0f, 300.0f, 500.0f);
  view.camera.target = Vec3(0.0f);
  Found found = stage.compare(view);
  EXPECT_EQ(found.seen, 600u);
  EXPECT_EQ(found.posed, 600u);
  EXPECT_EQ(found.at_keys, 600u);
  EXPECT_EQ(found.entries, found.draws * 600u) << "all wear the same";
  view.camera.target = Vec3(0.0f, 600.0f, 1000.0f);
  view.light.shadows = false;
  found = stage.compare(view);
  EXPECT_EQ(found.seen + found.casting + found.posed + found.draws, 0u);
}

// What one view has posed the next one has; another kind of pose is posed again.
TEST_F(DeviceCullingTest, PosesOncePerTime) {
  const Scene scene = testing::tubeScene(300);
  Stage stage(tubes_, crowdOf(scene, tubes_));
  ASSERT_TRUE(stage.canCull());
  View view = viewAmong(scene);
  view.snap_below = 110.0f;
  const std::size_t first = stage.compare(view).posed;
  EXPECT_GT(first, 100u);
  EXPECT_EQ(stage.compare(view).posed, 0u);
  view.snap_below = 0.0f;
  const std::size_t again = stage.compare(view).posed;
  EXPECT_GT(again, 10u);
  EXPECT_LT(again, first);
  stage.setTime(0.5);
  EXPECT_EQ(stage.compare(view).posed, first);
}

TEST_F(DeviceCullingTest, EqualsTheHostTileByTile) {
  const Scene scene = testing::tubeScene(800);
  Stage stage(tubes_, crowdOf(scene, tubes_));
  ASSERT_TRUE(stage.canCull());
  const View view = viewAmong(scene);
  const Found whole = stage.compare(view);
  stage.setTime(0.0);
  const Found tiled = stage.compare(view, {.side = 200, .pixels = 200 * 120});
  EXPECT_GT(tiled.seen, whole.seen) << "who stands on a border is in two";
  EXPECT_EQ(tiled.posed, whole.posed);
  EXPECT_EQ(tiled.casting, whole.casting);
}

TEST_F(DeviceCullingTest, EqualsTheHostInSeveralChunks) {
  const Scene scene = testing::tubeScene(700);
  for (const Technique technique : kAllTechniques) {
    Stage stage(tubes_, crowdOf(scene, tubes_), technique, 20000);
    ASSERT_TRUE(stage.canCull());
    EXPECT_GT(stage.state().chunks().size(), 3u);
    EXPECT_GT(stage.compare(viewAmong(scene)).seen, 100u);
  }
}

/// So many outfits that masks of all sub-meshes don't fit a group's memory at once. Draw states alternate.
Wardrobe manyOutfits(int count) {
  Wardrobe wardrobe = testing::tubeWardrobe();
  for (int i = 0; i < count; ++i) {
    Item item = testing::tubeItem("item" + std::to_string(i), wardrobe.body, [&](int region, int face) {
      return region != i % 3 || face % (2 + i % 5) == 0;
    });
    RawMaterial material = testing::clothMaterial("cloth.item" + std::to_string(i));
    material.double_sided = i % 4 != 0;
    const float radius = 0.22f + 0.0001f * static_cast<float>(i);
    testing::addBand(item, "garment.item" + std::to_string(i), material, radius, 0.5f, 1.2f);
    wardrobe.item_files.push("outfits/" + item.name + ".glb");
    wardrobe.items.push(std::move(item));
  }
  return wardrobe;
}

TEST_F(DeviceCullingTest, EqualsTheHostWithHundredsOfSubMeshes) {
  const Wardrobe wardrobe = manyOutfits(1200);
  const Scene scene = testing::tubeScene(3000);
  Stage stage(wardrobe, crowdOf(scene, wardrobe));
  ASSERT_TRUE(stage.canCull());
  EXPECT_GT(stage.itemCount(), 2u * ENSEMBLE_QUEUE_RANGE);
  const Found found = stage.compare(viewAmong(scene));
  EXPECT_GT(found.draws, std::size_t{ENSEMBLE_QUEUE_RANGE});
  View view = viewAmong(scene);
  view.camera.position = Vec3(0.0f, 300.0f, 500.0f);
  view.camera.target = Vec3(0.0f);
  EXPECT_EQ(stage.compare(view).seen, 3000u);
}

// People of trajectories come and go.
TEST_F(DeviceCullingTest, EqualsTheHostWhereNotEverybodyIsThere) {
  const testing::TemporaryFolder folder;
  {
    std::ofstream file(folder / "walk.txt");
    file << "# framerate: 8\n";
    for (int id = 1; id <= 150; ++id) {
      const int first = id % 40;
      for (int frame = first; frame < first + 25; ++frame)
        file << id << ' ' << frame << ' ' << 0.15 * (frame - first) << ' ' << 0.2 * (id - 75) << " 0\n";
    }
  }
  const Wardrobe sticks = testing::stickWardrobe();
  Scene scene;
  scene.file = "scene.yaml";
  scene.wardrobes.push_back({"", "memory", {}});
  scene.crowd.count = std::nullopt;
  scene.crowd.placement.kind = PlacementKind::kFile;
  scene.crowd.placement.file = {folder / "walk.txt", {}};
  Stage stage(sticks, crowdOf(scene, sticks));
  ASSERT_TRUE(stage.canCull());
  View view = viewAmong(scene);
  view.camera.position = Vec3(20.0f, 9.0f, 30.0f);
  view.camera.target = Vec3(0.0f, 0.5f, 0.0f);
  view.snap_below = 30.0f;
  std::size_t most = 0, least = 1000, at_keys = 0;
  for (double seconds = 0.0; seconds < 8.6; seconds += 0.6) {
    stage.setTime(seconds);
    const Found found = stage.compare(view);
    most = std::max(most, found.seen);
    least = std::min(least, found.seen);
    at_keys += found.at_keys;
  }
  EXPECT_GT(most, 70u);
  EXPECT_LT(most, 150u) << "never all at once";
  EXPECT_LT(least, 40u);
  EXPECT_GT(at_keys, 50u);
}

/// People whose balls touch a plane to within what rounding decides, as do those of the shadow map's sides,
/// and heights that are as tall on the screen as the limit of key frames.
class Borderline {
 public:
  Borderline(const View& view, const ShadowFit& fit, const Sphere& model_bounds, float height)
      : view_(view), casters_(casterRuleOf(fit)), bounds_(model_bounds), height_(height) {}

  Vec3 position(std::size_t kind) {
    if (kind % 3 == 0) return onRow(frustumOf(view_).planes[kind / 3 % 5], -bounds_.radius, 1.0f);
    if (kind % 3 == 1) {
      const Vec4 row = kind % 2 == 0 ? casters_.across_x : casters_.across_y;
      return onRow(row, 1.0f + bounds_.radius * casters_.scale, 0.15f);
    }
    const Vec3 middle(0.0f, 0.5f * height_, 0.0f);
    const float distance =
        pixelsPerTangent(view_) * height_ / view_.snap_below * (1.0f + 1e-8f * at_(random_));
    const Vec3 forward = cameraFrame(view_.camera).forward;
    return view_.camera.position - middle + distance * glm::normalize(forward + somewhere(0.01f));
  }

  /// Verdicts on planes that would be others if products and sums were fused.
  std::size_t fusedDiffer(std::span<const Sphere> bounds) const {
    const Frustum frustum = frustumOf(view_);
    std::size_t differing = 0;
    for (const Sphere& ball : bounds) {
      bool fused = true;
      for (const Vec4& plane : frustum.planes) {
        const float sum =
            std::fma(plane.z, ball.center.z, std::fma(plane.y, ball.center.y, plane.x * ball.center.x));
        fused = fused && !(sum + plane.w < -ball.radius);
      }
      differing += fused != frustum.touches(ball);
    }
    return differing;
  }

 private:
  Vec3 somewhere(float scale) {
    const float x = at_(random_), y = at_(random_), z = at_(random_);
    return scale * Vec3(x, 0.3f * y, z);
  }

  /// A place from which the ball's centre gives a row the value, the best of some.
  Vec3 onRow(const Vec4& row, float value, float scale) {
    Vec3 best(0.0f);
    double least = 1e9;
    for (int i = 0; i < 30; ++i) {
      Vec3 place = somewhere(scale);
      const auto beyond = [&] {
        return glm::dot(glm::dvec3(row), glm::dvec3(place + bounds_.center)) + double{row.w} - double{value};
      };
      place -= Vec3(row) * (static_cast<float>(beyond()) / glm::dot(Vec3(row), Vec3(row)));
      if (std::abs(beyond()) >= least) continue;
      least = std::abs(beyond());
      best = place;
    }
    return best;
  }

  View view_;
  CasterRule casters_;
  Sphere bounds_;
  float height_;
  std::mt19937 random_{17};
  std::uniform_real_distribution<float> at_{-30.0f, 30.0f};
};

TEST_F(DeviceCullingTest, DecidesOnTheBorderAsTheHostDoes) {
  const Scene scene = testing::tubeScene(6000);
  Crowd crowd = crowdOf(scene, tubes_);
  View view = viewAmong(scene);
  view.snap_below = 31.7f;
  const Animation animation = buildAnimation(std::span(&tubes_, 1));
  const std::vector<Sphere> near = {{Vec3(-2.0f, 1.0f, -3.0f), 1.3f}, {Vec3(5.0f, 1.0f, -9.0f), 1.1f}};
  const ShadowFit fit = fitShadowMap(view, near);
  Borderline borderline(view, fit, animation.bounds[0], animation.heights[0]);
  for (std::size_t i = 0; i < crowd.characters.size(); ++i) {
    Character& person = crowd.characters[i];
    person.heading = 0.0f;
    person.scale = 1.0f;
    person.position = borderline.position(i);
  }
  Stage stage(tubes_, std::move(crowd));
  ASSERT_TRUE(stage.canCull());
  const Found found = stage.compare(view, {}, &fit);
  EXPECT_GT(borderline.fusedDiffer(stage.state().bounds()), 50u) << "so the test can tell";
  EXPECT_GT(found.seen, 2000u);
  EXPECT_LT(found.seen, 5000u);
  EXPECT_GT(found.casting, 300u);
  EXPECT_GT(found.at_keys, 400u);
  EXPECT_GT(found.posed, found.at_keys + 400u);
}

TEST_F(DeviceCullingTest, IsNotPossibleWhereItsTablesDoNotFit) {
  const Scene scene = testing::tubeScene(200);
  EXPECT_FALSE(Stage(tubes_, crowdOf(scene, tubes_), Technique::kTagged, 300).canCull());
}

}  // namespace
}  // namespace ensemble
