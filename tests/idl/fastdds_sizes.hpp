// The sizes that code from Fast DDS's own generator gives for the same IDL: a second opinion. Behind a
// function, since both generators name their types alike.
#pragma once

#include <cstddef>
#include <map>
#include <string_view>

namespace eciton::bus {

struct SerializedSize {
  std::size_t size_max = 0;  // with encapsulation header, a multiple of 4
  std::size_t key_size = 0;
};

std::map<std::string_view, SerializedSize> fastdds_sizes();

}  // namespace eciton::bus
