#include "renderer/renderer_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "core/check.h"
#include "core/log.h"

namespace ensemble {

unsigned automaticRendererCount(const SequenceShape& shape) {
  constexpr std::size_t kMost = 8, kFramesEach = 4;
  constexpr unsigned kCoresEachComputed = 4;
  if (!shape.is_on_cpu) return 1;
  const std::size_t by_cores = shape.is_computed ? shape.cores / kCoresEachComputed : shape.cores;
  return static_cast<unsigned>(
      std::max<std::size_t>(1, std::min({kMost, by_cores, shape.frames / kFramesEach})));
}

RendererPool::RendererPool(const RendererOptions& options, const PoolScene& scene)
    : options_(options), scene_(scene) {
  if (!options_.memory) options_.memory = std::make_shared<MemoryBudget>();
  Member first{.number = 0, .renderer = std::make_unique<Renderer>(options_)};
  first.renderer->load(*scene.scene, scene.wardrobes, scene.environment);
  crowd_ = first.renderer->crowd();
  numbers_ = first.renderer->aovNumbers();
  device_name_ = first.renderer->deviceName();
  is_on_cpu_ = first.renderer->isOnCpu();
  idle_.push_back(std::move(first));
}

void RendererPool::allow(unsigned count) {
  ENSEMBLE_CHECK(count > 0u);
  const std::lock_guard lock(mutex_);
  allowed_ = count;
}

unsigned RendererPool::allowAutomatic(std::size_t frames, unsigned cores) {
  const SequenceShape shape{.is_on_cpu = is_on_cpu_, .cores = cores, .frames = frames};
  const unsigned most = automaticRendererCount(shape);
  const std::lock_guard lock(mutex_);
  allowed_ = most;
  automatic_ = shape;
  return most;
}

void RendererPool::draw(const View& view, double seconds, Picture& picture) {
  Member member = take();
  const auto render = [&] { member.renderer->render(std::span(&view, 1), seconds, std::span(&picture, 1)); };
  try {
    try {
      render();
    } catch (const std::exception& error) {
      const std::string why = error.what();
      if (!standAlone(member)) throw;
      render();
      warnOfOneOnly(why);
    }
  } catch (...) {
    give(std::move(member));  // others may wait for it
    throw;
  }
  letGrow(*member.renderer, view, picture.stats);
  give(std::move(member));
}

std::vector<std::string> RendererPool::validationMessages() const {
  std::map<std::size_t, std::vector<std::string>> by_number = messages_;
  for (const Member& member : idle_) by_number[member.number] = member.renderer->validationMessages();
  std::vector<std::string> all;
  for (const auto& [number, messages] : by_number) all.insert(all.end(), messages.begin(), messages.end());
  return all;
}

RendererPool::Member RendererPool::make(std::size_t number) const {
  Member member{.number = number, .renderer = std::make_unique<Renderer>(options_)};
  member.renderer->load(*scene_.scene, scene_.wardrobes, scene_.environment, crowd_);
  return member;
}

RendererPool::Member RendererPool::take() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (may_grow_ && count_ < allowed_) {
      grow(lock);
    } else if (!idle_.empty()) {
      Member member = std::move(idle_.back());
      idle_.pop_back();
      return member;
    } else {
      changed_.wait(lock);
    }
  }
}

void RendererPool::grow(std::unique_lock<std::mutex>& lock) {
  ++count_;
  const std::size_t number = next_number_++;
  lock.unlock();
  Member member;
  std::string why;
  try {
    member = make(number);
  } catch (const std::exception& error) {
    why = error.what();
  }
  lock.lock();
  if (!member.renderer) {
    --count_;
    allowed_ = std::min(allowed_, count_);
    logWarning(fmt::format("no more renderers can be made, frames are drawn by {}: {}", count_, why));
  } else if (count_ > allowed_) {
    --count_;
    retire(std::move(member));
  } else {
    ++made_;
    idle_.push_back(std::move(member));
  }
  changed_.notify_all();
}

void RendererPool::letGrow(const Renderer& first, const View& view, const FrameStats& stats) {
  const std::lock_guard lock(mutex_);
  if (std::exchange(may_grow_, true) || !automatic_) return;
  // Coverage is counted by the pipeline, person by person, whoever draws the picture.
  automatic_->is_computed = !view.coverage && 2 * stats.characters_computed >= stats.characters_drawn &&
                            stats.characters_computed > 0;
  // A quarter is left for what later frames need: more poses are kept, crowds come nearer.
  const std::uint64_t each = std::max<std::uint64_t>(first.memoryInUse(), 1);
  allowed_ =
      std::clamp<std::uint64_t>(first.memoryLimit() / 4 * 3 / each, 1, automaticRendererCount(*automatic_));
}

void RendererPool::give(Member member) {
  const std::lock_guard lock(mutex_);
  if (count_ > allowed_) {
    --count_;
    retire(std::move(member));
  } else {
    idle_.push_back(std::move(member));
  }
  changed_.notify_all();
}

bool RendererPool::standAlone(Member& member) {
  {
    std::unique_lock lock(mutex_);
    if (count_ == 1) return false;
    if (allowed_ > 1) {
      allowed_ = 1;
      count_ -= idle_.size();
      for (Member& other : std::exchange(idle_, {})) retire(std::move(other));
      changed_.wait(lock, [&] { return count_ == 1; });
      return true;
    }
    --count_;
    retire(std::move(member));
    changed_.notify_all();
  }
  member = take();
  return true;
}

void RendererPool::retire(Member member) { messages_[member.number] = member.renderer->validationMessages(); }

void RendererPool::warnOfOneOnly(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(has_warned_, true)) return;
  }
  logWarning(fmt::format("one renderer alone draws the rest of the frames: {}", why));
}

}  // namespace ensemble
