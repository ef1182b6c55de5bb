// A stand-in for ensembles: the processor advances one realisation after the other.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "engine/realisation/ensemble.h"

namespace peclet::engine {

// Makes numbers of steps that differ from turn to turn. It runs explicit steps alone; of more than 60 spheres
// it holds half as many. Expects to be used as ensemble.h says.
class ProcessorEnsemble : public Ensemble {
 public:
  explicit ProcessorEnsemble(std::size_t capacity, std::uint64_t longest_stride = 40)
      : capacity_(capacity), longest_stride_(longest_stride) {}
  ~ProcessorEnsemble() override { EXPECT_TRUE(members_.empty()); }

  std::string name() const override { return "stand-in 1"; }
  std::size_t capacity() const override { return capacity_; }
  std::size_t capacity(const Scene& scene) const override {
    if (scene.method == Method::implicit_steps) return 0;
    return scene.particles.count > 60 ? capacity_ / 2 : capacity_;
  }
  std::optional<InputError> refusal(const Scene& scene, const std::string& file) const override {
    if (capacity(scene) > 0) return std::nullopt;
    return InputError(file, "/integrator/method", "implicit", "must be explicit");
  }

  void add(Simulation& simulation) override {
    expect_one_user();
    EXPECT_FALSE(holds(simulation));
    members_.push_back(&simulation);
    most_ = std::max(most_, members_.size());
    double shares = 0;
    for (const Simulation* const one : members_) {
      shares += (one->system().particles.count() > 60 ? 2.0 : 1.0) / static_cast<double>(capacity_);
    }
    EXPECT_LE(shares, 1.000001);
  }
  std::vector<Ended> advance(std::chrono::duration<double> time) override {
    expect_one_user();
    EXPECT_FALSE(members_.empty());
    if (turns_left_-- == 0) throw std::runtime_error("the stand-in broke");
    std::vector<Ended> ended;
    const auto end = std::chrono::steady_clock::now() + std::min(time, std::chrono::duration<double>(0.01));
    while (ended.empty() && std::chrono::steady_clock::now() < end) {
      for (Simulation* const one : members_) {
        std::optional<Ending> ending = one->advance(1 + random_() % longest_stride_);
        if (ending) ended.push_back({one, std::move(*ending)});
      }
    }
    for (const Ended& one : ended) std::erase(members_, one.simulation);
    return ended;
  }
  void remove(Simulation& simulation) override {
    expect_one_user();
    EXPECT_TRUE(holds(simulation));
    std::erase(members_, &simulation);
  }
  std::uint64_t steps_made(const Simulation& simulation) const override { return simulation.system().step; }
  double net_strain(const Simulation& simulation) const override {
    return simulation.system().box.net_strain();
  }

  // Makes it break after a number of turns.
  void break_after(int turns) { turns_left_ = turns; }
  void forget_all() { members_.clear(); }
  // Returns the largest number of realisations that it has held.
  std::size_t most() const { return most_; }

 private:
  bool holds(const Simulation& simulation) const {
    return std::find(members_.begin(), members_.end(), &simulation) != members_.end();
  }
  void expect_one_user() {
    if (user_ == std::thread::id()) user_ = std::this_thread::get_id();
    EXPECT_EQ(user_, std::this_thread::get_id());
  }

  const std::size_t capacity_;
  const std::uint64_t longest_stride_;
  std::vector<Simulation*> members_;
  std::thread::id user_;
  std::minstd_rand random_{1};
  int turns_left_ = -1;
  std::size_t most_ = 0;
};

}  // namespace peclet::engine
