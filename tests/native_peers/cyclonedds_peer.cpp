// A program that knows Eciton only by its IDL, on Cyclone DDS and what idlc makes of it in C.
#include <dds/features.h>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#undef restrict

#include "native_cyclonedds/all.h"
#include "tests/native_peers/peer_main.hpp"
#include "tests/native_peers/visitors.hpp"

namespace eciton::native_peers {

template <std::size_t Size>
struct Text<char[Size]> {
  static constexpr bool is_text = true;
  static void assign(char (&field)[Size], const std::string& value) {
    std::memcpy(field, value.c_str(), std::min(Size, value.size() + 1));
  }
  static std::string get(const char (&field)[Size]) { return field; }
};
template <class T>
requires requires(T sequence) { sequence._buffer; }
struct Sequence<T> {
  static constexpr bool is_sequence = true;
  using Element = std::remove_pointer_t<decltype(T::_buffer)>;
  static void resize(T& field, std::uint32_t size) {
    field._length = field._maximum = size;
    field._release = true;
    field._buffer = size > 0 ? static_cast<Element*>(dds_alloc(size * sizeof(Element))) : nullptr;
  }
  static std::uint32_t size(const T& field) { return field._length; }
  static Element& at(T& field, std::uint32_t k) { return field._buffer[k]; }
};

#define ECITON_NATIVE_TYPE(name) eciton_msg_##name
#define ECITON_NATIVE_FIELD(name) name
#include "native_fields/all.inc"

namespace {

dds_entity_t join(std::uint32_t domain) {
  dds_create_domain(domain,
                    "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"lo\" "
                    "multicast=\"true\"/></Interfaces><AllowMulticast>spdp</AllowMulticast></General></Domain>"
                    "</CycloneDDS>");
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  if (participant < 0) std::exit(1);
  return participant;
}

template <class Sample>
class CycloneChannel final : public Channel {
 public:
  CycloneChannel(dds_entity_t participant, const char* topic, const dds_topic_descriptor_t& descriptor, TopicQos qos)
      : participant_(participant), name_(topic), descriptor_(descriptor), qos_(qos) {
    topic_ = dds_create_topic(participant, &descriptor, topic, nullptr, nullptr);
    if (topic_ < 0) std::exit(1);
  }

  const char* topic() const override { return name_; }
  std::vector<std::uint8_t> bytes(std::uint64_t seed) override {
    if (writer_ == 0) {
      open_writer();
      open_reader();
    }
    write(seed);  // to the reader beside it, at once
    ddsi_serdata* serdata = nullptr;
    dds_sample_info_t info;
    if (dds_takecdr(reader_, &serdata, 1, &info, DDS_ANY_STATE) != 1) std::exit(1);
    std::vector<std::uint8_t> bytes(ddsi_serdata_size(serdata));
    ddsi_serdata_to_ser(serdata, 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(serdata);
    return bytes;
  }
  void open_writer() override {
    dds_qos_t* qos = make_qos();
    writer_ = dds_create_writer(participant_, topic_, qos, nullptr);
    dds_delete_qos(qos);
    if (writer_ < 0) std::exit(1);
  }
  void open_reader() override {
    dds_qos_t* qos = make_qos();
    reader_ = dds_create_reader(participant_, topic_, qos, nullptr);
    dds_delete_qos(qos);
    if (reader_ < 0) std::exit(1);
  }
  void write(std::uint64_t seed) override {
    Sample sample = filled(seed);
    dds_write(writer_, &sample);
    dds_sample_free(&sample, &descriptor_, DDS_FREE_CONTENTS);
  }
  bool read(std::uint64_t& seen) override {
    void* loan[16] = {nullptr};
    dds_sample_info_t infos[16];
    const dds_return_t taken = dds_take(reader_, loan, infos, 16, 16);
    bool good = true;
    for (dds_return_t k = 0; k < taken; ++k) {
      if (!infos[k].valid_data) continue;
      std::uint64_t seed = 0;
      while (seed < kSeeds && !matches(*static_cast<Sample*>(loan[k]), seed)) ++seed;
      good = good && seed < kSeeds;
      seen |= std::uint64_t{1} << seed;
    }
    if (taken > 0) dds_return_loan(reader_, loan, taken);
    return good;
  }

 private:
  dds_qos_t* make_qos() const {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, qos_.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(100));
    dds_qset_durability(qos, qos_.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, qos_.depth);
    dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, qos_.depth, -1, -1, -1);
    return qos;
  }
  Sample filled(std::uint64_t seed) const {
    Sample sample{};
    Fill fill(name_, seed);
    visit_fields(fill, sample);
    return sample;
  }
  bool matches(Sample& sample, std::uint64_t seed) const {
    Compare compare(name_, seed);
    visit_fields(compare, sample);
    return compare.equal();
  }

  dds_entity_t participant_;
  const char* name_;
  const dds_topic_descriptor_t& descriptor_;
  TopicQos qos_;
  dds_entity_t topic_ = 0;
  dds_entity_t writer_ = 0;
  dds_entity_t reader_ = 0;
};

Channels channels(std::uint32_t domain) {
  const dds_entity_t participant = join(domain);
  Channels all;
#define TOPIC(name, type, reliable, transient_local, depth)                                                       \
  all.push_back(std::make_unique<CycloneChannel<eciton_msg_##type>>(participant, #name, eciton_msg_##type##_desc, \
                                                                    TopicQos{reliable, transient_local, depth}));
#include "tests/native_peers/topics.def"
#undef TOPIC
  return all;
}

}  // namespace
}  // namespace eciton::native_peers

int main(int count, char** arguments) {
  const int status = eciton::native_peers::peer_main(count, arguments, eciton::native_peers::channels);
  std::fflush(stdout);
  _exit(status);  // Entities are not taken down: the framework must stand peers that just go.
}
