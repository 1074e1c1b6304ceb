// eciton-bench-member --config MODULE.yaml --socket FILE: what a module needs to become part of a chain, composed in
// one process, without flying: estimation, membership and the radio, and beside them on the module's ring someone
// who plays its hardware host: says that a latch has caught, and tells what follows.
#include <poll.h>

#include <CLI/CLI.hpp>
#include <thread>

#include "benchmarks/formation/member_link.hpp"
#include "benchmarks/formation/membership_work.hpp"
#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/realtime_executor.hpp"
#include "deploy/module.hpp"
#include "deploy/program.hpp"

namespace {

using namespace eciton;
using bench::MemberNews;
using bench::MemberOrder;

/// A participant of its own: what it hears has been on the ring.
class HardwareStandIn {
 public:
  HardwareStandIn(const deploy::ModuleConfig& config, std::uint32_t ports, bench::MemberLink link)
      : module_id_(config.id),
        ring_(config.module_participant("hardware")),
        latch_(ring_.create_writer(topics::latch_state)),
        views_(ring_.create_reader(topics::chain_view)),
        wrenches_(ring_.create_reader(topics::contact_wrench)),
        link_(std::move(link)) {
    for (std::uint32_t port = 0; port < ports; ++port) set_latch(port, msg::LatchStatus::open);
    tell(MemberNews::What::hello);
  }

  void run(bench::MembershipWork& membership, const runtime::StopFlag& stop) {
    while (!stop.requested() && link_.is_open()) {
      std::array<pollfd, 3> wait{{{link_.fd(), POLLIN, 0},
                                  {ring_.waker().file_descriptor(), POLLIN, 0},
                                  {stop.file_descriptor(), POLLIN, 0}}};
      if (::poll(wait.data(), wait.size(), -1) < 0 && errno != EINTR) return;
      ring_.waker().clear();
      while (const auto order = link_.take_order()) follow(*order, membership);
      listen();
    }
  }

 private:
  void set_latch(std::uint32_t port, msg::LatchStatus status) {
    msg::LatchState state;
    state.module_id = module_id_;
    state.port = port;
    state.stamp_ns = to_ns(wall_now());
    state.status = status;
    latch_.write(state);
  }

  void tell(MemberNews::What what, std::uint64_t epoch = 0, std::uint32_t members = 0) {
    link_.send(MemberNews{.what = what,
                          .module_id = module_id_,
                          .monotonic_ns = monotonic_now().count(),
                          .epoch = epoch,
                          .members = members});
  }

  void follow(const MemberOrder& order, bench::MembershipWork& membership) {
    if (order.what == MemberOrder::What::latch) {
      tell(MemberNews::What::latched);
      set_latch(order.port, msg::LatchStatus::latched);
      return;
    }
    membership.order(order);
    if (order.what != MemberOrder::What::release) return;
    tell(MemberNews::What::released);
    set_latch(order.port, msg::LatchStatus::open);
  }

  void listen() {
    ring_.set_now(wall_now());
    while (const auto view = views_.take()) {
      const msg::ChainView& v = view->value;
      if (v.module_id != module_id_ || !v.active || (viewed_ && v.active_epoch == view_epoch_)) continue;
      viewed_ = true;
      view_epoch_ = v.active_epoch;
      tell(MemberNews::What::view, v.active_epoch, static_cast<std::uint32_t>(v.members.size()));
    }
    while (const auto wrench = wrenches_.take()) {
      if (wrench->value.module_id != module_id_ || wrench->value.epoch == wrench_epoch_) continue;
      wrench_epoch_ = wrench->value.epoch;
      tell(MemberNews::What::wrench, wrench_epoch_, static_cast<std::uint32_t>(wrench->value.members.size()));
    }
  }

  std::uint32_t module_id_;
  bus::Participant ring_;
  bus::Writer<msg::LatchState> latch_;
  bus::Reader<msg::ChainView> views_;
  bus::Reader<msg::ContactWrench> wrenches_;
  bench::MemberLink link_;
  bool viewed_ = false;
  std::uint64_t view_epoch_ = 0, wrench_epoch_ = 0;
};

int run(int argc, char** argv) {
  CLI::App app("A member of a chain that does not fly, for measuring.");
  std::string config_file, socket;
  app.add_option("--config", config_file, "the module's config")->required();
  app.add_option("--socket", socket, "of the program that measures")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& e) {
    throw BadInput{{e.what()}};
  }
  deploy::ModuleConfig config = value_or_throw(deploy::load_module_config({config_file}, {}));
  config.radio.incarnation = config.docking.incarnation = deploy::incarnation_at(wall_now());
  start_log(config.name + "/member");
  const auto ports = static_cast<std::uint32_t>(deploy::make_airframe(config).ports.size());
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  bench::MemberLink link = value_or_throw(bench::MemberLink::connect(socket));

  bus::Participant ring(config.module_participant("services"));
  bus::Participant swarm(config.swarm_participant("services"), &ring.waker());
  const auto estimation = deploy::make_service("estimation", config, ring, nullptr);
  bench::MembershipWork membership(ring, config.docking, ports);
  const auto radio = deploy::make_service("radio", config, ring, &swarm);
  runtime::RealtimeExecutor executor(
      {.module_id = config.id, .process = "services", .realtime_priority = config.realtime_priority},
      {&ring, &swarm});
  executor.add(*estimation);
  executor.add(membership);
  executor.add(*radio);
  std::thread services([&] { executor.run(stop); });
  HardwareStandIn(config, ports, std::move(link)).run(membership, stop);
  stop.request();
  services.join();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-bench-member", [&] { return run(argc, argv); });
}
