// Text, written beside its place and renamed into it.
#include "core/runtime/fault_record.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace eciton::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view suffix = ".csv";

/// Of the wall clock, if it was one: simulated worlds begin in 1970.
std::string date_of(TimePoint at) {
  const std::time_t s =
      static_cast<std::time_t>(std::chrono::floor<std::chrono::seconds>(at).time_since_epoch().count());
  std::tm utc{};
  char text[40] = "";
  if (::gmtime_r(&s, &utc) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &utc);
  return text;
}

std::string heading(const FaultNote& note, const std::vector<Column>& columns, std::size_t rows) {
  std::string text = "# fault of module " + std::to_string(note.module_id) + ", " + std::string(note.service) + ": " +
                     std::string(note.text) + "\n# at " + std::to_string(to_ns(note.at)) +
                     " ns of the module's clock, " + date_of(note.at) + "\n# its last " + std::to_string(rows) +
                     " steps, the oldest first; the last row is the step of the fault\n";
  if (note.missed > 0) {
    text += "# before it " + std::to_string(note.missed) +
            " faults got no file of their own: they came while another was being written\n";
  }
  text += "# SI units; frames: W the world, z up; M the module, at its composite centre of mass; nan: not known\n";
  text += "# stamp_ns: of the step, on the module's clock; before_s: how long before the fault that was\n";
  for (const Column& column : columns) {
    if (column.meaning.empty()) continue;
    text += "# " + column.name + ": " + column.meaning + "\n";
  }
  text += "stamp_ns,before_s";
  for (const Column& column : columns) text += "," + column.name;
  return text + "\n";
}

void append_value(std::string& text, const Column& column, double value) {
  if (!column.words.empty() && value >= 0 && value < static_cast<double>(column.words.size())) {
    text += column.words[static_cast<std::size_t>(value)];
    return;
  }
  char number[32];
  std::snprintf(number, sizeof number, "%.7g", value);
  text += number;
}

std::string body(const FaultNote& note, const std::vector<Column>& columns, const RowRing& rows) {
  std::string text;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    char time[64];
    std::snprintf(time, sizeof time, "%lld,%.4f", static_cast<long long>(to_ns(rows.stamp(k))),
                  to_s(note.at - rows.stamp(k)));
    text += time;
    const std::span<const double> row = rows.row(k);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text += ',';
      append_value(text, columns[c], row[c]);
    }
    text += '\n';
  }
  return text;
}

/// Whether all of it was taken; errno says why not.
bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

void add_columns(std::vector<Column>& columns, const std::string& name, std::string_view axes,
                 const std::string& unit, const std::string& meaning) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    columns.push_back({.name = name + "_" + axes[k] + (unit.empty() ? "" : "_" + unit),
                       .meaning = k == 0 ? meaning : std::string()});
  }
}

void add_rotor_columns(std::vector<Column>& columns, const std::string& name, std::size_t rotors,
                       const std::string& meaning) {
  for (std::size_t k = 0; k < rotors; ++k) {
    const std::string rotor = name + std::to_string(k);
    columns.push_back(
        {.name = rotor + "_thrust_N", .meaning = k == 0 ? meaning + "; gimbal 0 is the outer one" : std::string()});
    for (const char* gimbal : {"_gimbal0_rad", "_gimbal1_rad"}) columns.push_back({.name = rotor + gimbal});
  }
}

FaultRecordName fault_record_name(std::string_view service, TimePoint at) noexcept {
  char name[FaultRecordName::bound() + 1];
  std::snprintf(name, sizeof name, "%.*s-%019lld%s", static_cast<int>(service.size()), service.data(),
                static_cast<long long>(to_ns(at)), suffix.data());
  return name;
}

Status write_fault_record(const fs::path& file, const FaultNote& note, const std::vector<Column>& columns,
                          const RowRing& rows) {
  const std::string text = heading(note, columns, rows.size()) + body(note, columns, rows);
  const fs::path beside = file.string() + ".new";
  const auto refuse = [&](int why) {
    return Error{"fault record " + file.string() + " cannot be written: " + std::strerror(why)};
  };
  const int fd = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640);
  if (fd < 0) return refuse(errno);
  const int why = write_all(fd, text) ? 0 : errno;
  ::close(fd);
  if (why == 0 && ::rename(beside.c_str(), file.c_str()) == 0) return ok();
  const Error failed = refuse(why != 0 ? why : errno);
  ::unlink(beside.c_str());
  return failed;
}

void remove_old_fault_records(const fs::path& directory, std::string_view service, std::size_t kept) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator entry(directory, failed), end; !failed && entry != end; entry.increment(failed)) {
    std::string name = entry->path().filename().string();
    if (name.starts_with(std::string(service) + "-") && name.ends_with(suffix)) names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end());
  for (std::size_t k = 0; k + kept < names.size(); ++k) fs::remove(directory / names[k], failed);
}

}  // namespace eciton::runtime
