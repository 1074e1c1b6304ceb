// The main of every peer. On standard input, one command a line, and what is answered on standard output:
//   connect ADDRESS                                         ok
//   matched                                                 matched 0|1
//   begin BYTES BASE COUNT          (echo)                  ok; then it sends back what arrives
//   end                             (echo)                  block ..., see block.hpp
//   run BYTES BASE COUNT START PERIOD LINGER ns   (ping)    block ...
//   quit                                                    nothing
// First of all it says "ready ADDRESS" or "error MESSAGE". It ends when standard input does.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "benchmarks/latency/peers/block.hpp"
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/result.hpp"
#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

std::int64_t now_ns() { return monotonic_now().count(); }

void sleep_until(std::int64_t at_ns) {
  const timespec at{at_ns / 1'000'000'000, at_ns % 1'000'000'000};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

/// Standard input, line by line, read by a thread of its own: the main thread waits for samples.
class Commands {
 public:
  explicit Commands(std::function<void()> on_line) : on_line_(std::move(on_line)) {
    std::thread([this] { read_all(); }).detach();  // the process ends under it
  }

  std::string next() {
    std::unique_lock<std::mutex> lock(mutex_);
    came_.wait(lock, [this] { return !lines_.empty(); });
    std::string line = std::move(lines_.front());
    lines_.pop_front();
    waiting_.store(!lines_.empty(), std::memory_order_release);
    return line;
  }
  bool waiting() const noexcept { return waiting_.load(std::memory_order_acquire); }

 private:
  void read_all() {
    std::string line;
    char byte = 0;
    while (::read(STDIN_FILENO, &byte, 1) == 1) {
      if (byte != '\n') {
        line += byte;
        continue;
      }
      push(std::move(line));
      line.clear();
    }
    push("quit");
    std::this_thread::sleep_for(std::chrono::seconds(2));
    ::_exit(3);  // the transport holds the main thread: nobody waits for this process any more
  }
  void push(std::string line) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      lines_.push_back(std::move(line));
      waiting_.store(true, std::memory_order_release);
    }
    came_.notify_one();
    on_line_();
  }

  std::function<void()> on_line_;
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<std::string> lines_;
  std::atomic<bool> waiting_{false};
};

struct Order {
  std::uint32_t bytes = 0, base = 0, count = 0;
  std::int64_t start_ns = 0, period_ns = 0, linger_ns = 0;
};

class Peer final : public Sink {
 public:
  Peer(const PeerOptions& options, MakeTransport make, std::FILE* answers)
      : options_(options), answers_(answers), transport_(make(options, *this)), commands_([this] { interrupt(); }) {}

  void arrived(const Mark& mark, bool intact) noexcept override {
    const std::int64_t at_ns = now_ns();
    if (options_.role == Role::echo && !transport_->send(mark)) recorder_.refused();
    recorder_.received(mark.sequence, at_ns, intact);
  }

  void serve() {
    answer("ready " + transport_->address() + "\n");
    for (std::string line = commands_.next(); line != "quit"; line = commands_.next()) obey(line);
  }

 private:
  bool waits() const { return options_.delivery == Delivery::wake; }
  void interrupt() {
    if (waits()) transport_->interrupt();
  }

  void obey(const std::string& line) {
    Order order;
    char address[128];
    if (std::sscanf(line.c_str(), "connect %127s", address) == 1) {
      transport_->connect(address);
      answer("ok\n");
    } else if (line == "matched") {
      answer(transport_->matched() ? "matched 1\n" : "matched 0\n");
    } else if (std::sscanf(line.c_str(), "begin %" SCNu32 " %" SCNu32 " %" SCNu32, &order.bytes, &order.base,
                           &order.count) == 3) {
      begin(order);
      answer("ok\n");
      while (waits() && !commands_.waiting()) transport_->wait_until(now_ns() + 1'000'000'000);
    } else if (line == "end") {
      finish();
    } else if (std::sscanf(line.c_str(), "run %" SCNu32 " %" SCNu32 " %" SCNu32 " %" SCNd64 " %" SCNd64 " %" SCNd64,
                           &order.bytes, &order.base, &order.count, &order.start_ns, &order.period_ns,
                           &order.linger_ns) == 6) {
      begin(order);
      send_all(order);
      finish();
    } else {
      answer("error no command '" + line + "'\n");
    }
  }

  void begin(const Order& order) {
    transport_->select(order.bytes);
    recorder_.begin(order.base, std::min(order.count, BlockRecorder::capacity));
    before_ = usage_now();
  }

  void wait_until(std::int64_t at_ns) { waits() ? transport_->wait_until(at_ns) : sleep_until(at_ns); }

  /// Open loop: the instants are fixed beforehand, whatever comes back when.
  void send_all(const Order& order) {
    // The first instant counts from here where the command came too late for its own.
    const std::int64_t start_ns = std::max(order.start_ns, now_ns() + order.period_ns / 2);
    for (std::uint32_t k = 0; k < order.count; ++k) {
      const std::int64_t planned_ns = start_ns + k * order.period_ns;
      const std::int64_t ready_ns = now_ns();
      while (now_ns() < planned_ns) wait_until(planned_ns);
      recorder_.sending(k, planned_ns, ready_ns, now_ns());
      if (!transport_->send({order.base + k, planned_ns})) recorder_.refused();
    }
    constexpr std::int64_t look_every_ns = 2'000'000;
    const std::int64_t end_ns = now_ns() + order.linger_ns;
    while (recorder_.received_count() < order.count && now_ns() < end_ns) {
      wait_until(std::min(end_ns, now_ns() + look_every_ns));
    }
  }

  void finish() {
    const Usage used = usage_now() - before_;
    BlockReport report = recorder_.report();
    report.usage = used;
    answer(to_text(report));
  }

  void answer(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), answers_);
    std::fflush(answers_);
  }

  PeerOptions options_;
  std::FILE* answers_;
  BlockRecorder recorder_;
  Usage before_;
  std::unique_ptr<Transport> transport_;
  Commands commands_;
};

PeerOptions parse(int argc, char** argv) {
  PeerOptions options;
  CLI::App app("One end of a transport that `eciton bench latency` measures; started by it.");
  const std::map<std::string, Role> roles{{"ping", Role::ping}, {"echo", Role::echo}};
  const std::map<std::string, Delivery> deliveries{{"wake", Delivery::wake}, {"inline", Delivery::inlined}};
  app.add_option("--role", options.role)->required()->transform(CLI::CheckedTransformer(roles));
  app.add_option("--delivery", options.delivery)->transform(CLI::CheckedTransformer(deliveries));
  app.add_flag("--reliable", options.reliable);
  app.add_option("--dds", options.vendor);
  app.add_option("--domain", options.domain);
  app.add_option("--run", options.run);
  app.add_option("--interface", options.network_interface);
  app.add_option("--peer", options.peers)->allow_extra_args(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    std::exit(app.exit(help));
  } catch (const CLI::ParseError& error) {
    throw BadInput{{error.what()}};
  }
  return options;
}

/// Processor and policy are set by who starts us, alike for all programs.
void settle() {
  std::signal(SIGINT, SIG_IGN);  // of the terminal: the benchmark ends us by closing our input
  std::signal(SIGPIPE, SIG_IGN);
}

/// Standard output is the answers'; what libraries print there goes to standard error.
std::FILE* answers() {
  std::FILE* file = ::fdopen(::dup(STDOUT_FILENO), "w");
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  return file;
}

}  // namespace

int peer_main(int argc, char** argv, MakeTransport make) {
  std::FILE* file = answers();
  std::string error;
  try {
    const PeerOptions options = parse(argc, argv);
    settle();
    // Not destroyed: vendors take up to a second to say good-bye, and the reading thread uses it.
    auto* peer = new Peer(options, make, file);
    peer->serve();
    ::_exit(0);
  } catch (const BadInput& bad) {
    error = bad.error.message;
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  std::fprintf(file, "error %s\n", error.c_str());
  std::fflush(file);
  ::_exit(2);
}

}  // namespace eciton::bench
