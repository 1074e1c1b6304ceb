// dlopen with RTLD_LOCAL, so that two vendors live in one process, and a check of the ABI.
#include "core/bus/plugin_loader.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <sstream>

namespace eciton::bus {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view file_prefix = "lib" ECITON_PLUGIN_PREFIX;
constexpr std::string_view file_suffix = ".so";

std::vector<fs::path> search_directories() {
  std::vector<fs::path> directories;
  if (const char* path = std::getenv("ECITON_PLUGIN_PATH")) {
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, ':');) {
      if (!part.empty()) directories.emplace_back(part);
    }
  }
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (!none) {
    directories.push_back(program.parent_path().parent_path() / "lib");
    directories.push_back(program.parent_path().parent_path() / "lib" / "eciton");
  }
  return directories;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

Result<const eciton_plugin*> open_plugin(const std::string& vendor) {
  const std::string file = std::string(file_prefix) + vendor + std::string(file_suffix);
  void* library = nullptr;
  std::string where;
  for (const fs::path& directory : search_directories()) {
    std::error_code none;
    const fs::path candidate = directory / file;
    if (!fs::exists(candidate, none)) continue;
    where = candidate.string();
    library = ::dlopen(where.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return Error{"DDS plugin " + where + " does not load: " + ::dlerror()};
    break;
  }
  if (library == nullptr) {
    where = file;
    library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  if (library == nullptr) {
    std::vector<std::string> places;
    for (const fs::path& directory : search_directories()) places.push_back(directory.string());
    return Error{"DDS vendor '" + vendor + "': no " + file + " in " + joined(places) +
                 " or where the system's loader looks; available: " + joined(available_vendors())};
  }
  using Entry = const eciton_plugin* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(library, ECITON_PLUGIN_ENTRY));
  if (entry == nullptr) {
    return Error{"DDS plugin " + where + " exports no function " ECITON_PLUGIN_ENTRY ": it is not an Eciton plugin"};
  }
  const eciton_plugin* plugin = entry();
  if (plugin == nullptr || plugin->abi_version != ECITON_PLUGIN_ABI_VERSION ||
      plugin->struct_size != sizeof(eciton_plugin)) {
    return Error{"DDS plugin " + where + " has ABI version " +
                 (plugin == nullptr ? "none" : std::to_string(plugin->abi_version)) + ", this program needs " +
                 std::to_string(ECITON_PLUGIN_ABI_VERSION) + ": install the plugin of the same Eciton release"};
  }
  return plugin;
}

}  // namespace

Result<const eciton_plugin*> load_plugin(const std::string& vendor) {
  static std::mutex mutex;
  static std::map<std::string, const eciton_plugin*> loaded;
  const std::lock_guard lock(mutex);
  const bool plain = !vendor.empty() && std::all_of(vendor.begin(), vendor.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (!plain) {
    return Error{"DDS vendor '" + vendor + "' is not a vendor's name; available: " + joined(available_vendors())};
  }
  if (const auto found = loaded.find(vendor); found != loaded.end()) return found->second;
  auto plugin = open_plugin(vendor);
  if (plugin) loaded[vendor] = *plugin;
  return plugin;
}

std::vector<std::string> available_vendors() {
  std::vector<std::string> vendors;
  for (const fs::path& directory : search_directories()) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(directory, none)) {
      const std::string file = entry.path().filename().string();
      if (!file.starts_with(file_prefix) || !file.ends_with(file_suffix)) continue;
      vendors.push_back(file.substr(file_prefix.size(), file.size() - file_prefix.size() - file_suffix.size()));
    }
  }
  std::sort(vendors.begin(), vendors.end());
  vendors.erase(std::unique(vendors.begin(), vendors.end()), vendors.end());
  return vendors;
}

std::string chosen_vendor(const std::string& configured) {
  const char* named = std::getenv("ECITON_DDS");
  return named != nullptr && *named != '\0' ? named : configured;
}

}  // namespace eciton::bus
