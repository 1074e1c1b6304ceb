// The pure maths of one step: estimation, allocation, the contact-wrench law.
#include <array>
#include <memory>
#include <vector>

#include "benchmarks/micro/workload.hpp"
#include "core/robot/allocation.hpp"
#include "services/control/contact_wrench_law.hpp"
#include "services/control/pose_control.hpp"
#include "services/estimation/error_state_filter.hpp"
#include "services/estimation/momentum_observer.hpp"

namespace eciton::bench {
namespace {

using robot::Vector3;

constexpr std::int64_t imu_period_ns = 2'000'000;

/// A filter that hovers and is ready; poses come at 50 Hz, 20 ms late.
struct Hover {
  Hover() {
    for (int k = 0; k < 2000; ++k) {
      step();
      if (k % 10 == 0) pose();
    }
  }
  void step() {
    stamp_ns += imu_period_ns;
    filter.update(estimation::ImuSample{stamp_ns, {0.01, -0.02, 9.81}, {0.001, 0.002, -0.001}});
  }
  void pose() { filter.update(estimation::PoseMeasurement{stamp_ns - 10 * imu_period_ns, {}, 0.001, 0.003}); }

  estimation::ErrorStateFilter filter;
  std::int64_t stamp_ns = 0;
};

Step predict() {
  auto hover = std::make_shared<Hover>();
  return [hover] {
    hover->step();
    return hover->filter.covariance()(0, 0);
  };
}

Step fuse() {
  auto hover = std::make_shared<Hover>();
  return [hover] {
    hover->step();
    hover->pose();
    return hover->filter.covariance()(0, 0);
  };
}

Step observe() {
  auto observer = std::make_shared<estimation::MomentumObserver>();
  return [observer, n = 0]() mutable {
    estimation::MomentumInput in;
    in.mass_kg = 3.9;
    in.v_WM = {0.001 * (++n % 7), 0, 0};
    in.known_M = {{0, 0, 38.2}, {0.01, 0, 0}};
    if (!observer->update(in, 0.002)) return 0.0;
    return observer->wrench_W().force.x();
  };
}

Step allocate() {
  auto allocator = std::make_shared<robot::Allocator>(robot::legion());
  return [allocator, n = 0]() mutable {
    const double sway = 0.1 * (++n % 11);
    return allocator->update({{sway, -1, 38}, {0.2, -0.1, sway}}, {0.002, 0, 0.001}).rotors[0].thrust_N;
  };
}

Step pose_control() {
  auto control = std::make_shared<control::PoseControl>();
  return [control, n = 0]() mutable {
    control::PoseControlInput in;
    in.mass_kg = 3.9;
    in.state.p_WM = {0.01 * (++n % 5), 0, 0};
    return control->update(in, 0.002).force.z();
  };
}

Step local_law() {
  auto law = std::make_shared<control::ContactWrenchLaw>();
  auto members = std::make_shared<std::array<control::ChainMember, 8>>();
  for (std::size_t i = 0; i < members->size(); ++i) {
    (*members)[i].r_W = {-0.8 * static_cast<double>(i), 0, 1};
    (*members)[i].link_W = (*members)[i].r_W - Vector3(0.4, 0, 0);
  }
  return [law, members, n = 0]() mutable {
    (*members)[3].d_W.force.x() = 0.1 * (++n % 3 - 1);
    return law->update(*members, 3, {}, 0.01).force.x();
  };
}

}  // namespace

std::vector<Workload> maths_workloads() {
  return {
      {"estimation/filter_predict", predict, true},    {"estimation/filter_predict_and_fuse_20_ms_late", fuse, true},
      {"estimation/momentum_observer", observe, true}, {"control/allocation", allocate, true},
      {"control/pose_control", pose_control, true},    {"control/contact_wrench_law_of_8", local_law, true}};
}

}  // namespace eciton::bench
