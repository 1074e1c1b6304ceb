// A message to bytes and back, for the topics that fly at the highest rates and for the largest one.
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/idl/payload.hpp"
#include "benchmarks/micro/workload.hpp"
#include "core/bus/codec.hpp"
#include "idl/topics.hpp"

namespace eciton::bench {
namespace {

template <class T>
void add(std::vector<Workload>& list, const std::string& name, const T& sample) {
  const auto bytes = [] { return std::make_shared<std::vector<std::uint8_t>>(bus::TypeTraits<T>::size_max); };
  list.push_back({"codec/encode/" + name,
                  [sample, buffer = bytes()]() -> Step {
                    return [sample, buffer] { return static_cast<double>(bus::encode(sample, *buffer)); };
                  },
                  true});
  list.push_back({"codec/decode/" + name,
                  [sample, buffer = bytes()]() -> Step {
                    const std::size_t size = bus::encode(sample, *buffer);
                    auto out = std::make_shared<T>();
                    return [buffer, size, out] {
                      const bool good = bus::decode(std::span<const std::uint8_t>(*buffer).first(size), *out);
                      return good ? static_cast<double>(out->stamp_ns) : -1;
                    };
                  },
                  true});
}

}  // namespace

std::vector<Workload> codec_workloads() {
  std::vector<Workload> list;
  add(list, "imu", msg::Imu{.module_id = 1, .stamp_ns = 1});
  add(list, "module_state", msg::ModuleState{.module_id = 1, .stamp_ns = 1});
  msg::RotorCommand rotors{.module_id = 1, .stamp_ns = 1};
  rotors.rotors.resize(3);
  add(list, "rotor_command", rotors);
  add(list, "external_wrench", msg::ExternalWrench{.module_id = 1, .stamp_ns = 1});
  msg::ContactWrench contact{.module_id = 1, .stamp_ns = 1};
  contact.members.resize(8);
  add(list, "contact_wrench_of_8", contact);
  msg::Event event{.module_id = 1, .stamp_ns = 1, .service = "control", .machine = "flight", .from = "hover"};
  event.to = "move";
  add(list, "event", event);
  add(list, "payload_256", Payload256{.module_id = 1, .stamp_ns = 1});
  return list;
}

}  // namespace eciton::bench
