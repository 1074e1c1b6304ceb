// Whose use of the heap it is: the call stack against the address ranges of the loaded libraries.
#include "tests/allocation_guard/allocation_guard.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>

#include <algorithm>
#include <sstream>
#include <string_view>

namespace eciton::testing {
namespace {

// In the program itself, so that the first access allocates nothing.
thread_local AllocationGuard* active = nullptr;

constexpr std::string_view vendor_libraries[] = {"libfastrtps", "libddsc"};
constexpr std::string_view own_libraries = "libeciton";

std::string_view file_name(std::string_view path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

AllocationGuard::AllocationGuard() {
  list_libraries();
  std::array<void*, 4> warm_up;  // the first backtrace loads a library
  ::backtrace(warm_up.data(), static_cast<int>(warm_up.size()));
  active = this;
}

AllocationGuard::~AllocationGuard() { active = nullptr; }

void AllocationGuard::list_libraries() {
  const auto add = [](dl_phdr_info* info, std::size_t, void* context) {
    auto& self = *static_cast<AllocationGuard*>(context);
    const std::string_view name = file_name(info->dlpi_name);
    const bool own = name.empty() || name.starts_with(own_libraries);  // the program has no name
    const bool vendor = std::any_of(std::begin(vendor_libraries), std::end(vendor_libraries),
                                    [name](std::string_view each) { return name.starts_with(each); });
    if ((!own && !vendor) || self.library_count_ == self.libraries_.size()) return 0;
    std::uintptr_t begin = UINTPTR_MAX, end = 0;
    for (int k = 0; k < info->dlpi_phnum; ++k) {
      const auto& segment = info->dlpi_phdr[k];
      if (segment.p_type != PT_LOAD) continue;
      begin = std::min<std::uintptr_t>(begin, info->dlpi_addr + segment.p_vaddr);
      end = std::max<std::uintptr_t>(end, info->dlpi_addr + segment.p_vaddr + segment.p_memsz);
    }
    if (begin < end) self.libraries_[self.library_count_++] = {begin, end, own ? Owner::framework : Owner::vendor};
    return 0;
  };
  ::dl_iterate_phdr(add, this);
}

const AllocationGuard::Library* AllocationGuard::find(const void* address) const {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  for (std::size_t k = 0; k < library_count_; ++k)
    if (libraries_[k].begin <= at && at < libraries_[k].end) return &libraries_[k];
  return nullptr;
}

void AllocationGuard::record(const void* caller) noexcept {
  AllocationGuard* const guard = active;
  if (guard == nullptr) return;
  active = nullptr;  // what the walk itself may allocate does not count
  guard->count(caller);
  active = guard;
}

void AllocationGuard::count(const void* caller) noexcept {
  std::array<void*, frames_max> frames{};
  const int size = ::backtrace(frames.data(), frames_max);
  // The frames before the caller of malloc are ours.
  const auto end = frames.begin() + size;
  const auto begin = std::find(frames.begin(), end, caller);
  const auto owning = std::find_if(begin, end, [this](void* frame) { return find(frame) != nullptr; });
  if (owning != end && find(*owning)->owner == Owner::vendor) {
    ++vendor_;
    return;
  }
  if (framework_++ > 0) return;
  first_size_ = static_cast<int>(std::copy(begin, end, first_.begin()) - first_.begin());
}

std::string AllocationGuard::describe() {
  active = nullptr;
  std::ostringstream text;
  text << framework_ << " uses of the heap by Eciton, " << vendor_ << " by the vendor; the first by Eciton:";
  for (int k = 0; k < first_size_; ++k) {
    Dl_info info{};
    if (::dladdr(first_[k], &info) == 0) continue;
    const auto offset = static_cast<const char*>(first_[k]) - static_cast<const char*>(info.dli_fbase);
    text << "\n  " << info.dli_fname << " 0x" << std::hex << offset << std::dec;
    if (info.dli_sname != nullptr) text << ' ' << info.dli_sname;
  }
  return text.str();
}

}  // namespace eciton::testing
