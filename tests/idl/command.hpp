// Runs a tool and keeps what it says, for the tests that call idlc and fastddsgen. All take their paths
// from CMakeLists.txt.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace eciton {

struct Outcome {
  int status = -1;  // exit status, -1 if it did not exit by itself
  std::string output;
};

inline Outcome run_command(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> chunk{};
  for (std::size_t size = 0; (size = std::fread(chunk.data(), 1, chunk.size(), pipe)) > 0;) {
    outcome.output.append(chunk.data(), size);
  }
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

/// idlc with our back end.
inline Outcome generate(const std::filesystem::path& file, const std::filesystem::path& output_dir) {
  return run_command("'" ECITON_IDLC "' -l '" ECITON_IDL_GENERATOR "' -o '" + output_dir.string() + "' '" +
                     file.string() + "'");
}

/// An empty directory of this name below the test's own.
inline std::filesystem::path fresh_directory(const std::string& name) {
  const std::filesystem::path directory = std::filesystem::path(ECITON_SCRATCH_DIR) / name;
  std::filesystem::remove_all(directory);
  std::filesystem::create_directories(directory);
  return directory;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_file(const std::filesystem::path& path, std::string_view text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace eciton
