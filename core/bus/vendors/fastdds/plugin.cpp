// What the framework loads: the table of the plugin ABI, on Fast DDS.
#include <fastrtps/config.h>

#include "core/bus/vendors/fastdds/endpoints.hpp"
#include "core/bus/vendors/fastdds/participant.hpp"
#include "core/bus/vendors/plugin_table.hpp"

namespace {

constexpr eciton_plugin kPlugin = eciton::bus::vendors::plugin_table("fastdds", FASTRTPS_VERSION_STR);

}  // namespace

extern "C" __attribute__((visibility("default"))) const eciton_plugin* eciton_dds_plugin(void) { return &kPlugin; }
