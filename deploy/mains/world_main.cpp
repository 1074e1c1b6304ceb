// eciton-world --config WORLD.yaml: the simulated world, served to the modules' hardware hosts, and the truth
// about it, published by an observer that nothing depends on.
#include <memory>
#include <vector>

#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/robot/arrays.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/module_config.hpp"
#include "deploy/net/hosts.hpp"
#include "deploy/program.hpp"
#include "deploy/world_file.hpp"
#include "hal/sim/world_server.hpp"

namespace {

using namespace eciton;

constexpr Duration truth_period = std::chrono::milliseconds(10);

/// The truth of one module, on its ring.
class TruthObserver {
 public:
  TruthObserver(const deploy::WorldFile& file, std::uint32_t module)
      : module_(module),
        ring_({.vendor = file.dds, .domain = deploy::module_ring_domain(module), .name = "world/truth"}),
        pose_(ring_.create_writer(topics::truth_pose)),
        contact_(ring_.create_writer(topics::truth_contact)) {}

  void publish(const hal::sim::World& world, TimePoint now) {
    const hal::sim::TruthPose truth = world.truth_pose(module_);
    msg::TruthPose pose;
    pose.module_id = module_;
    pose.stamp_ns = to_ns(now);
    pose.p_WM_m = robot::array(truth.p_WM_m);
    pose.q_WM = robot::quaternion(truth.X_WB.R);
    pose.v_WM_m_s = robot::array(truth.v_WM_m_s);
    pose.w_WM_M_rad_s = robot::array(truth.w_WM_M_rad_s);
    pose_.write(pose);
    msg::TruthContact contact;
    contact.module_id = module_;
    contact.stamp_ns = to_ns(now);
    if (const auto truth_contact = world.truth_contact(module_, 0)) {
      contact.latched = true;
      contact.peer_id = truth_contact->peer_id;
      contact.point_W_m = robot::array(truth_contact->p_W_m);
      contact.force_W_N = robot::array(truth_contact->wrench_P_W.force);
      contact.moment_W_Nm = robot::array(truth_contact->wrench_P_W.moment);
    }
    contact_.write(contact);
  }

 private:
  std::uint32_t module_;
  bus::Participant ring_;
  bus::Writer<msg::TruthPose> pose_;
  bus::Writer<msg::TruthContact> contact_;
};

int run(int argc, char** argv) {
  const deploy::ProgramOptions options = deploy::parse_options(argc, argv, "The simulated world.");
  ConfigTree tree;
  for (const std::string& file : options.config_files) ok_or_throw(tree.add_file(file));
  for (const std::string& assignment : options.assignments) ok_or_throw(tree.set(assignment, "--set"));
  deploy::WorldFile file;
  ok_or_throw(read_config(tree, file));
  if (file.socket.empty()) throw BadInput{{"socket is missing; expected the path of the socket to serve"}};
  start_log("world", options.log_level);
  const bool wall = file.pace == "wall";
  // On the wall clock the world's stamps are the modules' own time.
  const bool own_time = wall && file.world.start_ns == 0;
  if (own_time) file.world.start_ns = static_cast<std::uint64_t>(to_ns(wall_now()));

  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  hal::sim::World world(file.world, robot::legion(file.airframe == "legion-lidar"), file.world.modules);
  hal::sim::WorldServer server(world, {.path = file.socket,
                                       .modules = {},
                                       .pace = wall ? hal::sim::Pace::wall : hal::sim::Pace::lockstep,
                                       .tick = from_s(file.tick_s)});
  ok_or_throw(server.open());
  std::vector<std::unique_ptr<TruthObserver>> observers;
  if (file.truth) {
    for (const std::uint32_t module : world.modules()) {
      const net::InNamespace inside(file.net.empty() ? "" : net::host_namespace(file.net, module));
      observers.push_back(std::make_unique<TruthObserver>(file, module));
    }
  }
  // What came before took its time, on a busy machine more than samples live: they would be stale for good.
  if (own_time) world.skip(wall_now() - world.now());
  TimePoint truth_due = world.now();
  server.set_observer([&](const hal::sim::World& seen, TimePoint now) {
    if (stop.requested()) server.stop();
    if (now < truth_due) return;
    truth_due = now + truth_period;
    for (auto& observer : observers) observer->publish(seen, now);
  });
  const Status status = server.run(TimePoint::max());
  if (status || stop.requested()) return 0;
  throw std::runtime_error(status.error().message);
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-world", [&] { return run(argc, argv); });
}
