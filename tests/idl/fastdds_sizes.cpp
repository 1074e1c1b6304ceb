// Includes what fastddsgen wrote, under other namespaces: its classes would otherwise be second definitions
// of our structs.
#include "tests/idl/fastdds_sizes.hpp"

#define eciton eciton_by_fastdds
#define eciton_test eciton_test_by_fastdds
#include "fastddsgen_sources.inc"
#undef eciton
#undef eciton_test

#include "idl/type_list.hpp"

namespace eciton_by_fastdds {

template <class T>
eciton::bus::SerializedSize size_of() {
  return {(4 + T::getMaxCdrSerializedSize() + 3) / 4 * 4, T::isKeyDefined() ? T::getKeyMaxCdrSerializedSize() : 0};
}

}  // namespace eciton_by_fastdds

std::map<std::string_view, eciton::bus::SerializedSize> eciton::bus::fastdds_sizes() {
#define eciton eciton_by_fastdds
#define eciton_test eciton_test_by_fastdds
#define NAMED_SIZE(type) {#type, eciton_by_fastdds::size_of<type>()},
  return {ECITON_IDL_TYPES(NAMED_SIZE)  //
          NAMED_SIZE(eciton_test::wide::EveryKind) NAMED_SIZE(eciton_test::wide::Unkeyed)
              NAMED_SIZE(eciton_test::Vector)};
}
