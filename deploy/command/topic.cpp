// The options of `eciton topic`, and its two commands that show rather than measure.
#include "deploy/command/topic.hpp"

#include <cstdio>
#include <memory>

#include "deploy/command/listener.hpp"
#include "deploy/command/measurement.hpp"
#include "deploy/command/topic_catalogue.hpp"

namespace eciton::deploy {
namespace {

using Options = std::shared_ptr<TopicOptions>;

void add_end(CLI::App& sub, TopicOptions& options) {
  sub.add_option("--count", options.count, "end after so many samples")->check(CLI::Range(1, 1'000'000'000));
  sub.add_option("--seconds", options.seconds, "end after this long, s")->check(CLI::Range(0.001, 1e6));
}

CLI::App* add_command(CLI::App& topic, const char* name, const char* purpose, TopicOptions& options) {
  CLI::App* sub = topic.add_subcommand(name, purpose);
  add_ring_options(*sub, options.ring);
  return sub;
}

void add_list(CLI::App& topic, Run& run) {
  const auto options = std::make_shared<TopicOptions>();
  options->seconds = 1;
  CLI::App* sub = add_command(topic, "list", "every topic, with who publishes it and how often", *options);
  sub->add_option("--seconds", options->seconds, "listen for this long, s (default: 1)")->check(CLI::Range(0.1, 1e4));
  sub->add_flag("--contract", options->contract_only, "only what idl/topics.hpp says; joins no ring");
  sub->add_option("--json", options->json_file, "write it to this file as well");
  on_chosen(*sub, run, [options] { return list_topics(*options); });
}

void add_echo(CLI::App& topic, Run& run) {
  const auto options = std::make_shared<TopicOptions>();
  CLI::App* sub = add_command(topic, "echo", "print samples as they arrive", *options);
  sub->add_option("TOPIC", options->topic, "as in 'eciton topic list'")->required();
  sub->add_flag("--json", options->json_lines, "one JSON object a line");
  add_end(*sub, *options);
  on_chosen(*sub, run, [options] { return echo_topic(*options); });
}

void add_measuring(CLI::App& topic, Run& run, const char* name, const char* purpose,
                   int (*measure)(const TopicOptions&)) {
  const auto options = std::make_shared<TopicOptions>();
  CLI::App* sub = add_command(topic, name, purpose, *options);
  sub->add_option("TOPIC", options->topic, "as in 'eciton topic list'")->required();
  sub->add_option("--window", options->window_s, "print figures over so many seconds (default: 1)")
      ->check(CLI::Range(0.1, 3600.0));
  add_end(*sub, *options);
  sub->add_option("--json", options->json_file, "write the figures over all samples to this file at the end");
  on_chosen(*sub, run, [options, measure] { return measure(*options); });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "-" : text;
}

void print_contract(const TopicEntry& entry) {
  const auto text = [](std::string_view view) { return std::string(view); };
  std::printf("%-17s %-28s %-8s %-7s %-23s", text(entry.info.name).c_str(), entry.info.type.name,
              text(bus::to_string(entry.info.qos)).c_str(), text(bus::to_string(entry.info.scope)).c_str(),
              joined(entry.keys).c_str());
}

Json contract_json(const TopicEntry& entry) {
  return {{"type", entry.info.type.name},
          {"class", bus::to_string(entry.info.qos)},
          {"scope", bus::to_string(entry.info.scope)},
          {"key", entry.keys}};
}

}  // namespace

void add_topic(CLI::App& app, Run& run) {
  CLI::App* topic = app.add_subcommand("topic", "what is on a ring, and how it arrives");
  add_list(*topic, run);
  add_echo(*topic, run);
  add_measuring(*topic, run, "hz", "how often samples arrive: rate and intervals", &measure_rate);
  add_measuring(*topic, run, "delay", "how old samples are on arrival: this host's clock less the stamp",
                &measure_delay);
  add_measuring(*topic, run, "bw", "how many bytes a second arrive", &measure_bandwidth);
}

int list_topics(const TopicOptions& options) {
  ok_or_throw(check_measurement_file(options.json_file));
  std::vector<const TopicEntry*> all;
  for (const TopicEntry& entry : topic_catalogue()) all.push_back(&entry);
  std::unique_ptr<Listener> listener;
  if (!options.contract_only) {
    listener = std::make_unique<Listener>(options.ring, "eciton topic list", all);
    std::fprintf(stderr, "listening on %s for %g s\n", listener->ring().c_str(), options.seconds);
    listener->run([](const Arrival&) { return true; }, from_s(options.seconds), 1s, [] {});
  }
  std::printf("%-17s %-28s %-8s %-7s %-23s%s\n", "TOPIC", "TYPE", "CLASS", "SCOPE", "KEY",
              listener ? " WRITERS  RATE" : "");
  Measurement measurement{.command = "topic list", .clock = "monotonic"};
  for (const TopicEntry* entry : all) {
    print_contract(*entry);
    Json& json = measurement.series[std::string(entry->info.name)] = contract_json(*entry);
    if (listener) {
      const double rate_Hz = static_cast<double>(listener->statistics(*entry).received) / options.seconds;
      std::printf(" %7u", listener->writers(*entry));
      if (rate_Hz > 0) std::printf("  %.4g Hz", rate_Hz);
      json["writers"] = listener->writers(*entry);
      json["rate_Hz"] = rate_Hz;
    }
    std::printf("\n");
  }
  if (listener) std::fprintf(stderr, "%s\n", listener->account().c_str());
  if (!options.json_file.empty()) {
    if (listener) measurement.config = {{"ring", listener->ring()}, {"seconds", options.seconds}};
    ok_or_throw(write_measurement(options.json_file, measurement));
  }
  return 0;
}

int echo_topic(const TopicOptions& options) {
  const TopicEntry& topic = find_topic(options.topic);
  Listener listener(options.ring, "eciton topic echo", {&topic});
  const auto print = [&](const Arrival&, const Decoded& sample) {
    if (options.json_lines) {
      std::printf("%s\n", sample.message.dump().c_str());
    } else {
      std::printf("%s---\n", to_text(sample.message).c_str());
    }
    std::fflush(stdout);
  };
  return listen(listener, topic, {.count = options.count, .seconds = options.seconds}, print, [] {});
}

}  // namespace eciton::deploy
