// The messages between a world process and its hardware hosts, over one Unix SOCK_SEQPACKET socket per
// host: the socket keeps their bounds, the header says which one it is. Same machine, same build: plain bytes.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/base/bounded.hpp"
#include "hal/sim/frames.hpp"

namespace eciton::hal::sim {

/// Changes with every change of these structs or of the frames.
inline constexpr std::uint32_t protocol_version = 2;

enum class MessageType : std::uint32_t { hello = 1, welcome, refused, sensors, actuators, bye };

enum class Pace : std::uint32_t {
  lockstep,  // the world waits for every host's answer to each tick
  wall       // the world keeps to the wall clock and takes the newest answers
};

/// First word of every message.
struct Hello {  // host: who I am
  MessageType type = MessageType::hello;
  std::uint32_t version = protocol_version;
  std::uint32_t module_id = 0;
};

struct Welcome {  // world: you are in
  MessageType type = MessageType::welcome;
  Pace pace = Pace::lockstep;
  std::int64_t tick_ns = 0;
  TimePoint now;
};

struct Refused {  // world: you are not, and the connection ends
  MessageType type = MessageType::refused;
  BoundedString<200> reason;
};

struct Sensors {  // world, each tick
  MessageType type = MessageType::sensors;
  std::uint64_t tick = 0;
  TimePoint stamp;
  SensorFrame frame;
};

struct Actuators {  // host, its answer to a tick
  MessageType type = MessageType::actuators;
  std::uint64_t tick = 0;  // that it answers
  TimePoint stamp;         // of the sensors acted on
  ActuatorFrame frame;
};

struct Bye {  // either side: no more comes
  MessageType type = MessageType::bye;
  BoundedString<200> reason;
};

static_assert(std::is_trivially_copyable_v<Hello> && std::is_trivially_copyable_v<Welcome> &&
              std::is_trivially_copyable_v<Refused> && std::is_trivially_copyable_v<Sensors> &&
              std::is_trivially_copyable_v<Actuators> && std::is_trivially_copyable_v<Bye>);

/// Room for any message.
inline constexpr std::size_t message_size_max =
    std::max({sizeof(Hello), sizeof(Welcome), sizeof(Refused), sizeof(Sensors), sizeof(Actuators), sizeof(Bye)});

}  // namespace eciton::hal::sim
