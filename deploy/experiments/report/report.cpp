// The report as files. Each is written beside its place and renamed: nobody reads half of one.
#include "deploy/experiments/report/report.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "deploy/report/draw.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;

Error cannot_write(const fs::path& path, int why) {
  return Error{"--report: " + path.string() + ": cannot be written: " + std::strerror(why)};
}

Status make_directory(const fs::path& directory) {
  std::error_code failed;
  fs::create_directories(directory, failed);
  if (!failed && fs::is_directory(directory, failed)) return ok();
  return cannot_write(directory, failed ? failed.value() : ENOTDIR);
}

/// errno of what failed; 0: written.
int write_bytes(const fs::path& path, const std::string& bytes) {
  const std::string draft = path.string() + "." + std::to_string(::getpid());
  bool written = false;
  {
    std::ofstream file(draft, std::ios::binary);
    file << bytes;
    written = static_cast<bool>(file.flush());
  }
  if (written && std::rename(draft.c_str(), path.c_str()) == 0) return 0;
  const int why = errno;
  std::remove(draft.c_str());
  return why;
}

Status write_file(const fs::path& path, const std::string& bytes) {
  const int why = write_bytes(path, bytes);
  return why == 0 ? ok() : cannot_write(path, why);
}

}  // namespace

std::string figures_markdown(const ReportInput& input) {
  std::string text = "`" + input.command_line + "`\n\n| metric | the paper | bar | ours | |\n|---|---|---|---|---|\n";
  for (const JudgedMetric& row : judge(input.experiment, input.conditions, input.metrics)) {
    if (row.paper.empty() && row.bar.empty()) continue;
    text += "| " + row.metric + " | " + (row.paper.empty() ? "–" : row.paper) + " | " +
            (row.bar.empty() ? "–" : row.bar) + " | " + row.ours + " | " + to_text(row.verdict) + " |\n";
  }
  return text;
}

Status check_report_directory(const std::string& directory) {
  if (directory.empty()) return ok();
  if (Status made = make_directory(directory); !made) return made;
  const fs::path trial = fs::path(directory) / (".eciton." + std::to_string(::getpid()));
  if (const int why = write_bytes(trial, ""); why != 0) return cannot_write(directory, why);
  std::remove(trial.c_str());
  return ok();
}

Result<std::string> write_report(const std::string& directory, const ReportInput& input) {
  const fs::path page = fs::path(directory) / (input.experiment + ".html");
  const fs::path parts = fs::path(directory) / input.experiment;
  if (Status status = make_directory(parts); !status) return status.error();
  for (const report::Plot& plot : input.plots) {
    const report::Drawing drawing = report::draw(plot);
    if (drawing.empty()) continue;
    if (Status status = write_file(parts / (plot.name + ".svg"), report::svg_file(plot, drawing)); !status) {
      return status.error();
    }
  }
  for (std::size_t i = 0; i < input.pictures.pictures.size(); ++i) {
    const fs::path file = parts / ("still_" + std::to_string(i + 1) + ".png");
    if (Status status = write_file(file, input.pictures.pictures[i].png); !status) return status.error();
  }
  if (Status status = write_file(parts / "figures.md", figures_markdown(input)); !status) return status.error();
  if (Status status = write_file(page, report_page(input)); !status) return status.error();
  return page.string();
}

}  // namespace eciton::deploy
