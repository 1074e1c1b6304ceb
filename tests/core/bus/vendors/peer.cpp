// One process of a fleet: joins a domain with a vendor's plugin, says its number, and ends when it has heard all
// the others and they it. Prints how long that took since its start. Usage: VENDOR DOMAIN NUMBER FLEET [PEER]
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

#include "tests/core/bus/vendors/plugin_handles.hpp"

int main(int count, char** arguments) {
  using namespace eciton::bus;
  if (count < 5) return 2;
  const auto start = std::chrono::steady_clock::now();
  const auto number = [&](int k) { return static_cast<std::uint32_t>(std::strtoul(arguments[k], nullptr, 10)); };
  const std::uint32_t self = number(3);
  const std::uint32_t fleet = number(4);
  std::vector<const char*> peers;
  if (count > 5) peers.push_back(arguments[5]);
  TestParticipant participant(arguments[1], number(2), peers);
  if (participant.handle() == nullptr) {
    std::fprintf(stderr, "%s\n", participant.error().c_str());
    return 1;
  }
  // Both kinds of traffic: state must reach every late joiner, sensor samples flow once matched both ways.
  const eciton_qos state = {1, 1, 1, 64};
  const eciton_qos sensor = {0, 0, 1, 64};
  TestWriter hello(participant, "hello", kKeyed, state);
  TestReader hellos(participant, "hello", kKeyed, state);
  TestWriter pulse(participant, "pulse", kKeyed, sensor);
  TestReader pulses(participant, "pulse", kKeyed, sensor);
  std::set<std::uint32_t> heard;
  std::set<std::uint32_t> felt;
  hello.write(sample(self, 0));
  std::uint32_t told = 0;  // what we last said of how many we hear
  double hello_ms = 0.0;
  double pulse_ms = 0.0;
  std::set<std::uint32_t> content;  // those that hear and feel everyone
  const auto elapsed_ms = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  const bool complete = wait_for(
      [&] {
        pulse.write(sample(self, 1));
        hellos.take();
        pulses.take();
        for (const Cdr& cdr : hellos.taken) {
          heard.insert(key_of(cdr));
          if (count_of(cdr) == 1) content.insert(key_of(cdr));
        }
        for (const Cdr& cdr : pulses.taken) felt.insert(key_of(cdr));
        hellos.taken.clear();
        pulses.taken.clear();
        if (hello_ms == 0.0 && heard.size() == fleet - 1) hello_ms = elapsed_ms();
        if (pulse_ms == 0.0 && felt.size() == fleet - 1) pulse_ms = elapsed_ms();
        if (told == 0 && hello_ms > 0.0 && pulse_ms > 0.0) hello.write(sample(self, told = 1));
        return told == 1 && content.size() == fleet - 1;
      },
      std::chrono::seconds(20));
  std::printf("%s %u: heard %zu of %u, state after %.0f ms, sensor after %.0f ms, all content after %.0f ms (%zu)\n",
              arguments[1], self, heard.size(), fleet - 1, hello_ms, pulse_ms, elapsed_ms(), content.size());
  std::fflush(stdout);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the others may still need our last word
  return complete ? 0 : 1;
}
