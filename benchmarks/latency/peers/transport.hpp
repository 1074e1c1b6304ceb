// What a peer of the latency benchmark asks of the transport under test. One small program per transport has one
// of these and the common main; everything that is timed is on this side of it, alike for all.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace eciton::bench {

/// Bytes of a payload's CDR without its header of four; what a transport without CDR carries raw.
inline constexpr std::array<std::uint32_t, 4> payload_sizes{64, 256, 1024, 4096};

enum class Role : std::uint8_t { ping, echo };

/// wake: the thread that waits for samples takes them. inlined: the transport's own thread hands each over.
enum class Delivery : std::uint8_t { wake, inlined };

/// Of a sample, what the benchmark reads.
struct Mark {
  std::uint32_t sequence = 0;
  std::int64_t stamp_ns = 0;
};

class Sink {
 public:
  /// `intact`: the filling arrived as it was sent. From one thread at a time.
  virtual void arrived(const Mark& mark, bool intact) noexcept = 0;

 protected:
  ~Sink() = default;
};

struct PeerOptions {
  Role role = Role::ping;
  Delivery delivery = Delivery::inlined;
  bool reliable = false;  // QoS class command instead of sensor
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 0;
  std::string run = "bench";  // how this run's topics begin, so that two runs do not hear each other
  std::string network_interface = "lo";
  std::vector<std::string> peers{};  // none: discovery by multicast
};

class Transport {
 public:
  virtual ~Transport() = default;

  /// How the other end reaches this one, in one word; "-": they find each other.
  virtual std::string address() const { return "-"; }
  virtual void connect(const std::string& /*address*/) {}
  /// Whether the other end is known to be there, as far as this end can tell.
  virtual bool matched() { return true; }
  /// The size of what send() sends and wait_until() takes from now on.
  virtual void select(std::uint32_t bytes) = 0;
  /// False: refused.
  virtual bool send(const Mark& mark) noexcept = 0;
  /// Only for Delivery::wake: sleeps until a sample, the instant (monotonic) or an interruption; gives what came
  /// to the sink.
  virtual void wait_until(std::int64_t /*monotonic_ns*/) noexcept {}
  /// Ends a wait_until early; from any thread.
  virtual void interrupt() noexcept {}
};

/// The filling of a sample, so that a transport that loses the end of it shows.
template <class Values>
void fill(Values& values) {
  double value = 0.5;
  for (double& each : values) each = value++;
}
template <class Values>
bool is_filled(const Values& values) {
  const std::size_t size = sizeof values / sizeof(double);
  return values[0] == 0.5 && values[size - 1] == static_cast<double>(size) - 0.5;
}

/// "bench7_ping_256": what one role writes and the other reads.
inline std::string topic_name(const PeerOptions& options, Role writer, std::uint32_t bytes) {
  return options.run + (writer == Role::ping ? "_ping_" : "_echo_") + std::to_string(bytes);
}
inline Role other(Role role) { return role == Role::ping ? Role::echo : Role::ping; }

using MakeTransport = std::unique_ptr<Transport> (*)(const PeerOptions& options, Sink& sink);

/// The whole program: options, then commands on standard input, answers on standard output; see peer_main.cpp.
int peer_main(int argc, char** argv, MakeTransport make);

}  // namespace eciton::bench
