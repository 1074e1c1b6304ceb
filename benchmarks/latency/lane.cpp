// The conversation with the two peers of a lane; every answer has a deadline.
#include "benchmarks/latency/lane.hpp"

#include <algorithm>

#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

constexpr Duration answer_time = std::chrono::seconds(3);

std::string command(const char* verb, const BlockOrder& order, std::uint32_t base) {
  return std::string(verb) + " " + std::to_string(order.bytes) + " " + std::to_string(base) + " " +
         std::to_string(order.count);
}

}  // namespace

void Lane::give_up(const std::string& why) {
  if (good()) trouble_ = why;
  ping_.reset();
  echo_.reset();
}

void Lane::start() {
  for (auto [spec, process] : {std::pair(&spec_.ping, &ping_), std::pair(&spec_.echo, &echo_)}) {
    Result<Process> started = Process::start(*spec);
    if (!started) return give_up(started.error().message);
    process->emplace(std::move(started).value());
  }
}

std::optional<std::string> Lane::heard(Process& of, Duration deadline, const runtime::StopFlag& stop) {
  const char* const role = ping_ && &of == &*ping_ ? "ping" : "echo";
  Result<std::string> line = of.hear(deadline, stop);
  if (line && line->starts_with("error ")) line = Error{line->substr(6)};
  if (line) return *line;
  const std::string& why = line.error().message;
  give_up(why == interrupted ? why : std::string(role) + ": " + why);
  return std::nullopt;
}

std::optional<std::string> Lane::ask(Process& of, const std::string& line, Duration patience,
                                     const runtime::StopFlag& stop) {
  of.say(line);  // what became of a peer that is gone, its silence tells
  return heard(of, monotonic_now() + patience, stop);
}

void Lane::greet(Duration deadline, const runtime::StopFlag& stop) {
  if (!good()) return;
  std::string addresses[2];
  for (auto [process, address] : {std::pair(&ping_, &addresses[0]), std::pair(&echo_, &addresses[1])}) {
    const auto ready = heard(**process, deadline, stop);
    if (!ready) return;
    if (!ready->starts_with("ready ")) return give_up("a peer began with '" + *ready + "'");
    *address = ready->substr(6);
  }
  if (!ask(*ping_, "connect " + addresses[1], answer_time, stop)) return;
  ask(*echo_, "connect " + addresses[0], answer_time, stop);
}

bool Lane::look_for_match(const runtime::StopFlag& stop) {
  if (!good()) return true;
  const auto ping = ask(*ping_, "matched", answer_time, stop);
  if (!ping) return true;
  const auto echo = ask(*echo_, "matched", answer_time, stop);
  return !echo || (*ping == "matched 1" && *echo == "matched 1");
}

void Lane::warm_up(BlockOrder order, Duration deadline, const runtime::StopFlag& stop) {
  std::int64_t slowest_ns = 0;
  std::size_t answered = 0;
  while (good()) {
    const std::optional<Block> block = run(order, stop);
    if (!block) return;
    answered = 0;
    slowest_ns = 0;
    for (const SampleRecord& each : block->ping.records) {
      if (each.received_ns == 0) continue;
      ++answered;
      slowest_ns = std::max(slowest_ns, each.received_ns - each.sent_ns);
    }
    if (answered == block->ping.records.size() || monotonic_now() > deadline) break;
  }
  if (good() && answered == 0) return give_up("no sample came back: is the link between the two ends up?");
  linger_ = std::clamp<Duration>(4 * Duration{slowest_ns}, std::chrono::milliseconds(20), std::chrono::seconds(1));
}

std::optional<BlockReport> Lane::report(Process& of, Duration deadline, const runtime::StopFlag& stop) {
  const auto head = heard(of, deadline, stop);
  if (!head) return std::nullopt;
  BlockReport report;
  const int count = parse_head(*head, report);
  bool good_text = count >= 0;
  for (int k = 0; k < count && good_text; ++k) {
    const auto line = heard(of, deadline, stop);
    if (!line) return std::nullopt;
    good_text = parse_record(*line, report.records.emplace_back());
  }
  if (good_text) return report;
  give_up("a peer answered what is no block: '" + *head + "'");
  return std::nullopt;
}

void Lane::prepare(const BlockOrder& order, const runtime::StopFlag& stop) {
  if (!good()) return;
  if (stop.requested()) return give_up(interrupted);
  order_ = order;
  base_ = std::exchange(next_sequence_, next_sequence_ + order.count);
  ask(*echo_, command("begin", order, base_), answer_time, stop);
}

void Lane::send_from(Duration start) {
  if (!good()) return;
  const auto period_ns = static_cast<std::int64_t>(1e9 / order_.rate_Hz);
  ping_->say(command("run", order_, base_) + " " + std::to_string(start.count()) + " " + std::to_string(period_ns) +
             " " + std::to_string(linger_.count()));
  latest_end_ = start + Duration{period_ns * order_.count} + linger_;
}

std::optional<Block> Lane::collect(const runtime::StopFlag& stop) {
  if (!good()) return std::nullopt;
  auto ping = report(*ping_, latest_end_ + answer_time, stop);
  if (!ping) return std::nullopt;
  echo_->say("end");
  auto echo = report(*echo_, monotonic_now() + answer_time, stop);
  if (!echo) return std::nullopt;
  return Block{std::move(*ping), std::move(*echo)};
}

std::optional<Block> Lane::run(const BlockOrder& order, const runtime::StopFlag& stop) {
  prepare(order, stop);
  send_from(monotonic_now() + std::chrono::milliseconds(1));
  return collect(stop);
}

}  // namespace eciton::bench
