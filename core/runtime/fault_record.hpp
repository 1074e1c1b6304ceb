// The file of one fault: the rows before it as comma-separated values, under a heading that says what each column
// is, in which unit and frame. For people and for whatever reads CSV with '#' as its sign of comments.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/bounded.hpp"
#include "core/base/result.hpp"
#include "core/runtime/row_ring.hpp"

namespace eciton::runtime {

struct Column {
  std::string name;                       // with its unit, as "p_WM_x_m"
  std::string meaning{};                  // for the heading; empty: that of the column before goes on
  std::vector<std::string_view> words{};  // of the values 0, 1, ...; empty: it is a number
};

/// "p_WM" in "m" becomes p_WM_x_m, p_WM_y_m and p_WM_z_m, for "wxyz" also p_WM_w_m; an empty unit: none.
void add_columns(std::vector<Column>& columns, const std::string& name, std::string_view axes,
                 const std::string& unit, const std::string& meaning);

/// Of each rotor a thrust and two gimbal angles: name0_thrust_N, name0_gimbal0_rad and so on.
void add_rotor_columns(std::vector<Column>& columns, const std::string& name, std::size_t rotors,
                       const std::string& meaning);

/// What the heading says beside the columns.
struct FaultNote {
  std::uint32_t module_id = 0;
  std::string_view service;
  TimePoint at{};
  std::string_view text;
  std::uint64_t missed = 0;  // faults since the file before, which came while that was still being written
};

using FaultRecordName = BoundedString<63>;

/// "control-1700000000000000000.csv": by name, a service's files are in the order of time. Real-time safe.
FaultRecordName fault_record_name(std::string_view service, TimePoint at) noexcept;

/// The whole file, or none.
Status write_fault_record(const std::filesystem::path& file, const FaultNote& note,
                          const std::vector<Column>& columns, const RowRing& rows);

/// Removes all files of a service but the newest.
void remove_old_fault_records(const std::filesystem::path& directory, std::string_view service, std::size_t kept);

}  // namespace eciton::runtime
