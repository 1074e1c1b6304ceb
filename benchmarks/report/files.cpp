// The result as files. Each is written beside its place and renamed: nobody reads half of one.
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>

#include "benchmarks/report/result.hpp"
#include "benchmarks/statistics/summary.hpp"
#include "deploy/command/measurement.hpp"

namespace eciton::bench {
namespace {

Error cannot_write(const std::string& option, const std::string& path, int why) {
  return Error{option + " " + path + ": cannot be written: " + std::strerror(why)};
}

std::string draft_of(const std::string& path) { return path + "." + std::to_string(::getpid()); }

Status check_file(const std::string& option, const std::string& path) {
  if (path.empty()) return ok();
  const std::string draft = draft_of(path);
  if (!std::ofstream(draft)) return cannot_write(option, path, errno);
  std::remove(draft.c_str());
  return ok();
}

Status write_file(const std::string& option, const std::string& path,
                  const std::function<void(std::ostream&)>& write) {
  const std::string draft = draft_of(path);
  {
    std::ofstream file(draft, std::ios::binary);
    write(file);
    if (!file.flush()) return cannot_write(option, path, errno);
  }
  if (std::rename(draft.c_str(), path.c_str()) == 0) return ok();
  const int why = errno;
  std::remove(draft.c_str());
  return cannot_write(option, path, why);
}

/// The shortest text that reads back to the same bits.
void add_number(std::string& text, double value) {
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void add_field(std::string& text, const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) {
    text += field;
    return;
  }
  text += '"';
  for (const char c : field) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  text += '"';
}

/// A distribution for programs; the raw values are in --csv.
Json series_of(const Samples& samples) {
  const Summary s = summarize(samples);
  Json json{{"unit", samples.unit}, {"count", s.count}, {"partial", samples.partial}};
  if (samples.sent > 0) {
    json["sent"] = samples.sent;
    json["lost"] = samples.lost;
    json["duplicates"] = samples.duplicates;
  }
  if (s.count == 0) return json;
  const Json figures{{"mean", s.mean},  {"p50", s.p50},      {"p90", s.p90}, {"p99", s.p99},
                     {"p99.9", s.p999}, {"p99.99", s.p9999}, {"max", s.max}};
  json.update(figures);
  if (s.count > 1) {
    json["jitter_mean"] = s.jitter_mean;
    json["jitter_p99"] = s.jitter_p99;
  }
  return json;
}

deploy::Measurement measurement_of(const Result& result) {
  deploy::Measurement out;
  out.command = result.command;
  out.clock = result.clock;
  out.config = result.config;
  out.seed = result.seed;
  out.metrics = result.metrics;
  for (const Samples& samples : result.samples) out.series[samples.name] = series_of(samples);
  out.series["partial"] = result.partial;
  out.series["notes"] = result.notes;
  return out;
}

}  // namespace

void write_csv(std::ostream& file, const Result& result) {
  file << "name,unit,at_s,value\n";
  for (const Samples& samples : result.samples) {
    std::string name;
    add_field(name, samples.name);
    name += ',';
    add_field(name, samples.unit);
    name += ',';
    std::string line;
    for (std::size_t i = 0; i < samples.values.size(); ++i) {
      line = name;
      if (i < samples.at_s.size()) add_number(line, samples.at_s[i]);
      line += ',';
      add_number(line, samples.values[i]);
      file << line << '\n';
    }
  }
}

Status check_report_files(const ReportFiles& files) {
  if (Status status = deploy::check_measurement_file(files.json); !status) return status;
  if (Status status = check_file("--csv", files.csv); !status) return status;
  return check_file("--html", files.html);
}

Status write_report_files(const ReportFiles& files, const Result& result) {
  Status first = ok();
  const auto keep = [&](Status status) {
    if (first && !status) first = std::move(status);
  };
  if (!files.json.empty()) keep(deploy::write_measurement(files.json, measurement_of(result)));
  if (!files.csv.empty()) keep(write_file("--csv", files.csv, [&](std::ostream& file) { write_csv(file, result); }));
  if (!files.html.empty())
    keep(write_file("--html", files.html, [&](std::ostream& file) { file << to_html(result); }));
  return first;
}

}  // namespace eciton::bench
