// Faults in flight leave files, whose last rows hold what the services really saw and sent: as the topics on the
// module's ring say, which somebody else recorded.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;

/// A fault record: its rows by the names of its columns.
struct Record {
  explicit Record(const fs::path& file) {
    std::ifstream in(file);
    std::vector<std::string> names;
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("#")) {
        heading += line + "\n";
        continue;
      }
      std::vector<std::string> cells;
      std::stringstream cut(line);
      for (std::string cell; std::getline(cut, cell, ',');) cells.push_back(cell);
      if (names.empty()) {
        names = cells;
        continue;
      }
      EXPECT_EQ(cells.size(), names.size());
      rows.emplace_back();
      for (std::size_t k = 0; k < std::min(cells.size(), names.size()); ++k) rows.back()[names[k]] = cells[k];
    }
  }
  std::string heading;
  std::vector<std::map<std::string, std::string>> rows;
};

class FaultRecordTest : public ::testing::Test {
 protected:
  FaultRecordTest() {
    std::string pattern = (fs::temp_directory_path() / "eciton-faults-XXXXXX").string();
    scratch_ = ::mkdtemp(pattern.data());
  }
  ~FaultRecordTest() override { fs::remove_all(scratch_); }

  /// Hovers, and listens from then on.
  void fly(const std::string& directory) {
    SimulationConfig config = row_of(1, 9);
    config.module.recorder.directory = directory;
    state_reader_.reset(), command_reader_.reset(), fault_reader_.reset();
    pilot_.reset();
    simulation_.reset();
    simulation_.emplace(config);
    pilot_.emplace(*simulation_);
    pilot_->bring_to_hover({1.0});
    bus::Participant& ear = simulation_->listener(0);
    state_reader_.emplace(ear.create_reader(topics::module_state));
    command_reader_.emplace(ear.create_reader(topics::rotor_command));
    fault_reader_.emplace(ear.create_reader(topics::fault));
    simulation_->executor().observe([this](TimePoint) {
      while (const auto s = state_reader_->take()) states_[s->value.stamp_ns] = s->value;
      while (const auto c = command_reader_->take()) commands_[c->value.stamp_ns] = c->value;
      while (const auto f = fault_reader_->take()) faults_.push_back(f->value);
    });
    pilot_->wait(1.2);
    faults_.clear();
  }
  /// The one fault of a service with such a text.
  const msg::Fault& fault(std::string_view service, std::string_view part) const {
    for (const msg::Fault& f : faults_) {
      if (f.service.view() == service && f.text.view().find(part) != std::string_view::npos) return f;
    }
    ADD_FAILURE() << service << " never said '" << part << "'";
    static const msg::Fault none;
    return none;
  }
  Record record(const msg::Fault& fault) const {
    const fs::path file = scratch_ / "m1" / fault.record.view();
    for (const Duration end = monotonic_now() + 10s; !fs::exists(file) && monotonic_now() < end;) {
      std::this_thread::sleep_for(1ms);
    }
    EXPECT_TRUE(fs::is_regular_file(file)) << file;
    return Record(file);
  }
  static void expect_near(const std::map<std::string, std::string>& row, const std::string& column, double value) {
    const double kept = std::stod(row.at(column));
    EXPECT_NEAR(kept, value, 1e-6 * (1 + std::abs(value))) << column;
  }
  static void expect_rotors(const std::map<std::string, std::string>& row, const std::string& name,
                            const msg::RotorCommand& command) {
    ASSERT_EQ(command.rotors.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string rotor = name + std::to_string(k);
      expect_near(row, rotor + "_thrust_N", command.rotors[k].thrust_N);
      expect_near(row, rotor + "_gimbal0_rad", command.rotors[k].gimbal_rad[0]);
      expect_near(row, rotor + "_gimbal1_rad", command.rotors[k].gimbal_rad[1]);
    }
  }

  fs::path scratch_;
  std::optional<Simulation> simulation_;
  std::optional<Pilot> pilot_;
  std::optional<bus::Reader<msg::ModuleState>> state_reader_;
  std::optional<bus::Reader<msg::RotorCommand>> command_reader_;
  std::optional<bus::Reader<msg::Fault>> fault_reader_;
  std::map<std::int64_t, msg::ModuleState> states_;  // by stamp
  std::map<std::int64_t, msg::RotorCommand> commands_;
  std::vector<msg::Fault> faults_;
};

TEST_F(FaultRecordTest, ControlsHoldsWhatItSawAndSentUntilItsStateWasLost) {
  fly(scratch_);
  const std::size_t before = commands_.size();
  simulation_->suspend(0, "estimation");
  pilot_->wait(0.5);
  ASSERT_GT(before, 500u);
  const msg::Fault& lost = fault("control", "module state too old");
  EXPECT_EQ(lost.severity, msg::Severity::error);
  const Record kept = record(lost);
  EXPECT_NE(kept.heading.find("fault of module 1, control: module state too old"), std::string::npos) << kept.heading;
  EXPECT_NE(kept.heading.find("state_p_WM_x_m: the newest module state: position of M in W"), std::string::npos);
  ASSERT_EQ(kept.rows.size(), 500u);

  const auto& last = kept.rows.back();
  EXPECT_EQ(last.at("stamp_ns"), std::to_string(lost.stamp_ns));
  EXPECT_EQ(last.at("flight_mode"), "failsafe");
  EXPECT_EQ(last.at("sent"), "nothing") << "silent from this step on";
  // What it held, as the last one to be heard on the ring.
  const auto& [state_stamp_ns, state] = *states_.rbegin();
  expect_near(last, "state_p_WM_z_m", state.p_WM_m[2]);
  expect_near(last, "state_v_WM_x_m_s", state.v_WM_m_s[0]);
  expect_near(last, "state_q_WM_w", state.q_WM[0]);
  expect_near(last, "state_age_s", 1e-9 * static_cast<double>(lost.stamp_ns - state_stamp_ns));
  EXPECT_NEAR(std::stod(last.at("reference_p_WM_z_m")), 1.0, 0.1) << "the hover's";

  // Each earlier step sent what the ring carried at its stamp.
  std::size_t sent = 0;
  for (std::size_t k = 0; k + 1 < kept.rows.size(); ++k) {
    const auto& row = kept.rows[k];
    ASSERT_EQ(row.at("sent"), "armed") << k;
    EXPECT_EQ(row.at("flight_mode"), "hover");
    const auto command = commands_.find(std::stoll(row.at("stamp_ns")));
    ASSERT_NE(command, commands_.end()) << row.at("stamp_ns");
    expect_rotors(row, "rotor", command->second);
    const auto acted_on = states_.find(command->second.state_stamp_ns);
    ASSERT_NE(acted_on, states_.end());
    expect_near(row, "state_p_WM_x_m", acted_on->second.p_WM_m[0]);
    ++sent;
  }
  EXPECT_EQ(sent, 499u);
  // The negative control: a row is not just any row.
  const auto& other = commands_.at(std::stoll(kept.rows[100].at("stamp_ns")));
  EXPECT_GT(std::abs(std::stod(kept.rows[300].at("rotor0_gimbal0_rad")) - other.rotors[0].gimbal_rad[0]), 1e-6);
}

TEST_F(FaultRecordTest, TheHardwareHostsHoldsTheLastCommandAndWhatItWroteInstead) {
  fly(scratch_);
  simulation_->suspend(0, "control");
  pilot_->wait(0.5);
  const msg::Fault& lost = fault("hardware", "no rotor command for 20 ms");
  const Record kept = record(lost);
  ASSERT_EQ(kept.rows.size(), 500u);
  const auto& [stamp_ns, command] = *commands_.rbegin();
  const auto& last = kept.rows.back();
  EXPECT_EQ(last.at("stamp_ns"), std::to_string(lost.stamp_ns));
  EXPECT_EQ(last.at("rotors_armed"), "yes");
  EXPECT_EQ(last.at("safe_output"), "descending");
  EXPECT_EQ(last.at("command_safe_output"), "descend");
  expect_near(last, "command_age_s", 1e-9 * static_cast<double>(lost.stamp_ns - stamp_ns));
  EXPECT_GT(std::stod(last.at("command_taken_s")), 0.02);
  expect_rotors(last, "commanded", command);
  double weight_N = 0;
  for (int k = 0; k < 3; ++k) weight_N += std::stod(last.at("written" + std::to_string(k) + "_thrust_N"));
  EXPECT_NEAR(weight_N, robot::legion().mass_kg * robot::gravity_m_s2, 2) << "level, its own weight";
  // Until then it wrote what it was told.
  const auto& held = kept.rows[kept.rows.size() - 2];
  EXPECT_EQ(held.at("safe_output"), "idle");
  expect_rotors(held, "written", command);
  EXPECT_TRUE(fs::exists(scratch_ / "m1" / lost.record.view()));
}

TEST_F(FaultRecordTest, WithoutADirectoryTheSameFlightWritesNothingAndIsTheSameToTheBit) {
  const auto flight = [&](const std::string& directory) {
    states_.clear(), commands_.clear();
    fly(directory);
    simulation_->suspend(0, "estimation");
    pilot_->wait(2);
    return std::pair(simulation_->world().truth_pose(1).p_WM_m, commands_.rbegin()->second.rotors[0].thrust_N);
  };
  const auto without = flight("");
  EXPECT_TRUE(fault("control", "module state too old").record.empty());
  EXPECT_TRUE(fs::is_empty(scratch_));
  const auto with = flight(scratch_);
  EXPECT_FALSE(fault("control", "module state too old").record.empty());
  EXPECT_EQ(without, with);
}

}  // namespace
}  // namespace eciton::deploy
