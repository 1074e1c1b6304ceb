// Formations and discoveries one after the other, each with members of its own; then the tables.
#include "benchmarks/formation/formation.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <span>

#include "benchmarks/formation/chain_trials.hpp"
#include "benchmarks/formation/formation_report.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/plugin_loader.hpp"
#include "deploy/supervisor/launch.hpp"

namespace eciton::bench {
namespace {

constexpr double trial_s = 1.5;  // about; with the end of the link
constexpr double start_s = 8;    // of members

std::vector<FormationCase> formation_cases(const FormationOptions& options) {
  std::vector<FormationCase> cases;
  if (!options.form) return cases;
  for (const std::uint32_t modules : options.modules) {
    const std::size_t pairs =
        modules == options.pairs_at ? options.pairs.size() : std::min<std::size_t>(1, options.pairs.size());
    for (std::size_t k = 0; k < pairs; ++k) cases.push_back({modules, options.pairs[k]});
  }
  return cases;
}

std::vector<DiscoveryCase> discovery_cases(const FormationOptions& options) {
  std::vector<DiscoveryCase> cases;
  if (!options.discover || !options.hosts) return cases;
  for (const bool lean : {true, false}) {
    for (const std::string& vendor : options.discovery_vendors) {
      for (const std::uint32_t modules : options.discovery_modules) cases.push_back({lean, vendor, modules});
    }
  }
  return cases;
}

void check(const FormationOptions& options) {
  const auto within = [](const std::vector<std::uint32_t>& modules, std::uint32_t max, const char* what) {
    for (const std::uint32_t n : modules) {
      if (n < 2 || n > max) {
        throw BadInput{
            {std::string(what) + " of " + std::to_string(n) + " modules: expected 2 to " + std::to_string(max)}};
      }
    }
  };
  within(options.modules, 8, "a chain");
  within(options.discovery_modules, 16, "discovery");
  for (const double loss : options.losses) {
    if (!(loss >= 0 && loss < 1)) throw BadInput{{"a loss of " + std::to_string(loss) + ": expected 0 to below 1"}};
    if (loss > 0 && !options.hosts) {
      throw BadInput{{"a loss of " + loss_name(loss) + " % over loopback, which loses nothing: it takes hosts"}};
    }
  }
  std::vector<std::string> vendors = options.discovery_vendors;
  for (const VendorPair& pair : options.pairs) vendors.insert(vendors.end(), {pair.first, pair.second});
  for (const std::string& vendor : vendors) {
    if (const auto plugin = bus::load_plugin(vendor); !plugin) throw BadInput{plugin.error()};
  }
  std::vector<const char*> programs{"eciton-bench-member"};
  if (options.hosts) programs.insert(programs.end(), {"eciton-bench-participant", "eciton-service", "eciton"});
  for (const char* program : programs) {
    if (!std::filesystem::exists(options.programs / program)) {
      throw BadInput{
          {"program " + (options.programs / program).string() + " is not there; build it, or give its directory"}};
    }
  }
}

/// Runs what is asked for and fills the result; one per run.
class FormationRun {
 public:
  FormationRun(const FormationOptions& options, const RunControl& control, Result& result)
      : options_(options), control_(control), result_(result), begin_(monotonic_now()) {}

  void run() {
    const auto formations = formation_cases(options_);
    const auto discoveries = discovery_cases(options_);
    all_ = formations.size() * options_.losses.size() + discoveries.size();
    left_s_ = static_cast<double>(formations.size()) * formation_s() +
              static_cast<double>(discoveries.size()) * discovery_s();
    bring_up_net(formations, discoveries);
    for (const FormationCase& which : formations) {
      if (!control_.stop.requested()) form(which);
    }
    if (net_) static_cast<void>(net_->set("", "", {"clear"}));
    for (const DiscoveryCase& which : discoveries) {
      if (!control_.stop.requested()) discover(which);
    }
    finish();
  }

 private:
  double discovery_s() const { return options_.settle_s + options_.joining_s + options_.idle_s; }

  void bring_up_net(const std::vector<FormationCase>& formations, const std::vector<DiscoveryCase>& discoveries) {
    if (!options_.hosts) return;
    std::uint32_t hosts = 2;
    for (const FormationCase& which : formations) hosts = std::max(hosts, which.modules);
    for (const DiscoveryCase& which : discoveries) hosts = std::max(hosts, which.modules);
    net_.emplace(value_or_throw(
        net::OwnedNet::start({.name = options_.net, .modules = hosts, .seed = options_.seed}, options_.programs)));
  }

  void fail(const std::string& what, const std::string& why, std::span<FormationSamples> samples = {}) {
    result_.notes.push_back(what + ": " + why);
    result_.partial = true;
    for (FormationSamples& s : samples) s.mark_partial();
  }

  void form(const FormationCase& which) {
    const std::string name = std::to_string(which.modules) + "." + which.pair.name();
    std::vector<FormationSamples> samples;
    for (const double loss : options_.losses) samples.emplace_back(which, loss);
    const double left_after_s = left_s_ - formation_s();
    try {
      for (std::size_t session = 0; session < options_.sessions; ++session) {
        if (net_) ok_or_throw(net_->set("", "", {"clear"}));
        control_.tell(finished_, all_, left_s_, name + ": starting");
        ChainTrials trials(options_, control_, net_ ? &*net_ : nullptr, which.modules, which.pair);
        trials.prepare();
        for (std::size_t k = 0; k < options_.losses.size(); ++k) {
          form_at(trials, options_.losses[k], samples[k], trials_of(session));
        }
      }
    } catch (const FormationFailure& failure) {
      fail(name, failure.why, samples);
    } catch (const BadInput& bad) {  // the net is gone, say; what was measured before is not lost
      fail(name, bad.error.message, samples);
    }
    for (FormationSamples& s : samples) s.move_to(formations_);
    left_s_ = left_after_s;
    finished_ += options_.losses.size();
  }

  double formation_s() const {
    return static_cast<double>(options_.sessions) * start_s +
           static_cast<double>(options_.losses.size() * options_.trials) * trial_s;
  }

  std::size_t trials_of(std::size_t session) const {
    return (session + 1) * options_.trials / options_.sessions - session * options_.trials / options_.sessions;
  }

  void form_at(ChainTrials& trials, double loss, FormationSamples& samples, std::size_t count) {
    if (net_) ok_or_throw(net_->set("", "", {"loss=" + loss_name(loss) + "%"}));
    for (std::size_t k = 0; k < count; ++k) {
      control_.tell(finished_, all_, left_s_, samples.name() + ", " + std::to_string(k + 1));
      const double at_s = to_s(monotonic_now() - begin_);
      samples.add(at_s, trials.trial());
      left_s_ -= trial_s;
    }
  }

  void discover(const DiscoveryCase& which) {
    control_.tell(finished_, all_, left_s_, "discovery, " + which.name());
    try {
      discoveries_.emplace_back(which, measure_discovery(options_, which, *net_, control_));
    } catch (const FormationFailure& failure) {
      fail("discovery, " + which.name(), failure.why);
    } catch (const BadInput& bad) {
      fail("discovery, " + which.name(), bad.error.message);
    }
    left_s_ -= discovery_s();
    ++finished_;
  }

  void finish() {
    add_formations(result_, std::move(formations_));
    add_discoveries(result_, discoveries_);
    if (!options_.hosts) {
      result_.notes.emplace_back("over loopback: without hosts there is no loss, and no count of discovery");
    }
  }

  const FormationOptions& options_;
  const RunControl& control_;
  Result& result_;
  Duration begin_;
  std::optional<net::OwnedNet> net_;
  std::vector<Samples> formations_;
  Discoveries discoveries_;
  std::size_t finished_ = 0, all_ = 0;
  double left_s_ = 0;
};

Json config_of(const FormationOptions& o) {
  Json pairs = Json::array();
  for (const VendorPair& pair : o.pairs) pairs.push_back(pair.name());
  return {{"modules", o.modules},
          {"losses", o.losses},
          {"pairs", pairs},
          {"pairs_at", o.pairs_at},
          {"trials", o.trials},
          {"sessions", o.sessions},
          {"hosts", o.hosts},
          {"realtime_priority", o.realtime_priority},
          {"discovery_modules", o.discover ? o.discovery_modules : std::vector<std::uint32_t>{}},
          {"discovery_vendors", o.discovery_vendors},
          {"idle_s", o.idle_s},
          {"joining_s", o.joining_s},
          {"settle_s", o.settle_s},
          {"set", o.assignments}};
}

}  // namespace

Result run_formation(const FormationOptions& given, const runtime::StopFlag& stop, const Progress& progress) {
  ::unsetenv("ECITON_DDS");  // the vendors asked for here count more
  const RunControl control{stop, progress};
  FormationOptions options = given;
  if (options.programs.empty()) options.programs = deploy::program_directory();
  options.sessions = std::clamp<std::size_t>(options.sessions, 1, std::max<std::size_t>(options.trials, 1));
  check(options);
  if (options.hosts) ok_or_throw(net::check_rights());
  Result result;
  result.title = "Chain formation";
  result.command = "bench formation";
  result.clock = "monotonic";
  result.config = config_of(options);
  result.seed = options.seed;
  FormationRun(options, control, result).run();
  result.partial = result.partial || stop.requested();
  return result;
}

}  // namespace eciton::bench
