// What a page or a drawing must be, by a parser that is not ours.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace eciton::report {

/// Pages and drawings are written so that they are XML; an XML parser forgives nothing.
inline bool well_formed(const std::string& text) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("eciton_report_" + std::to_string(::getpid()) + ".xml")).string();
  std::ofstream(file) << text;
  const int status = std::system((ECITON_XMLLINT " --noout --nonet '" + file + "' 2>/dev/null").c_str());
  std::filesystem::remove(file);
  return status == 0;
}

inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace eciton::report
