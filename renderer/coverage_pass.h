// How many pixels each person of a picture would cover if nobody and nothing stood before him.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/crowd_draw.h"
#include "renderer/view_targets.h"

namespace ensemble {

/// Draws person after person, each by himself under an occlusion query, with the vertex shader and the
/// culling of the AOV pass, so that no person shows more pixels there than are counted here.
class CoveragePass {
 public:
  /// @throws SystemError if the device's occlusion queries don't count
  CoveragePass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets);

  /// Takes down who is to be drawn: all who are in the queues, now.
  void plan(const QueueBuffers& queues);
  /// People are drawn some at a time, so that a command buffer stays small: a submission for each group.
  std::size_t groupCount() const { return (people_.size() + kGroup - 1) / kGroup; }
  /// Clears targets.aov_depth and draws a group into it. @pre targets.addAovs()
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const ViewTargets& targets,
              const View& view, std::size_t group) const;
  /// Adds what the group's people covered once it has been drawn.
  /// @param first_of_chunk per chunk of people: the number of its first
  /// @param pixels #people of the crowd
  void collect(const gpu::Device& device, std::span<const std::uint32_t> first_of_chunk, std::size_t group,
               std::span<std::uint32_t> pixels) const;

 private:
  static constexpr std::size_t kGroup = 1024;

  /// One sub-mesh of one person.
  struct PersonDraw {
    std::uint32_t person = 0;    ///< number in the chunk
    std::uint32_t instance = 0;  ///< index into the queue entries
    std::uint32_t draw = 0, batch = 0;
  };
  struct Person {
    std::uint32_t chunk = 0, number = 0;  ///< number in the chunk
    std::size_t first_draw = 0, draw_count = 0;
  };
  void recordPerson(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const Person& person,
                    vk::Pipeline& bound) const;

  VariantPipelines pipelines_ = noPipelines();
  vk::raii::QueryPool queries_ = nullptr;
  std::vector<PersonDraw> draws_;
  std::vector<Person> people_;
};

}  // namespace ensemble
