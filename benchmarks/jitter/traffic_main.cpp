// eciton-bench-traffic --write|--read --domain D: the samples of three peers on a module's ring, or one who hears
// them.
#include <CLI/CLI.hpp>

#include "core/base/wall_clock.hpp"
#include "core/bus/participant.hpp"
#include "core/runtime/sleeper.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/program.hpp"
#include "idl/topics.hpp"

namespace {

using namespace eciton;

constexpr Duration period = std::chrono::milliseconds(2);
constexpr std::array<std::uint32_t, 3> peers{81, 82, 83};

template <class T>
class Flow {
 public:
  Flow(bus::Participant& ring, const bus::Topic<T>& topic) : writer_(ring.create_writer(topic)) {}
  void write(TimePoint now) {
    for (const std::uint32_t peer : peers) {
      sample_.module_id = peer;
      sample_.stamp_ns = to_ns(now);
      writer_.write(sample_);
    }
  }

 private:
  T sample_{};
  bus::Writer<T> writer_;
};

void write(bus::Participant& ring, const runtime::StopFlag& stop) {
  Flow state(ring, topics::module_state);
  Flow joints(ring, topics::joint_state);
  Flow wrench(ring, topics::external_wrench);
  runtime::Sleeper sleeper(ring.waker(), stop);
  for (Duration due = monotonic_now(); !stop.requested(); due += period) {
    sleeper.until_undisturbed(due);
    const TimePoint now = wall_now();
    state.write(now);
    joints.write(now);
    wrench.write(now);
  }
}

void read(bus::Participant& ring, const runtime::StopFlag& stop) {
  auto states = ring.create_reader(topics::module_state);
  auto joints = ring.create_reader(topics::joint_state);
  auto wrenches = ring.create_reader(topics::external_wrench);
  runtime::Sleeper sleeper(ring.waker(), stop);
  while (!stop.requested()) {
    sleeper.for_at_most(std::chrono::seconds(1));
    ring.set_now(wall_now());
    while (states.take()) {
    }
    while (joints.take()) {
    }
    while (wrenches.take()) {
    }
  }
}

int run(int argc, char** argv) {
  CLI::App app("Traffic on a module's ring, for measuring.");
  bus::ParticipantConfig config{.name = "traffic"};
  bool writes = false, reads = false;
  auto* as_writer = app.add_flag("--write", writes);
  app.add_flag("--read", reads)->excludes(as_writer);
  app.add_option("--dds", config.vendor);
  app.add_option("--domain", config.domain)->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& e) {
    throw BadInput{{e.what()}};
  }
  if (writes == reads) throw BadInput{{"expected --write or --read"}};
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  bus::Participant ring(config);
  writes ? write(ring, stop) : read(ring, stop);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-bench-traffic", [&] { return run(argc, argv); });
}
