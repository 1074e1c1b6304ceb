// What the framework loads: the table of the plugin ABI, on Cyclone DDS.
#include <dds/version.h>

#include "core/bus/vendors/cyclonedds/entities.hpp"
#include "core/bus/vendors/plugin_table.hpp"

namespace {

constexpr eciton_plugin kPlugin = eciton::bus::vendors::plugin_table("cyclonedds", DDS_VERSION);

}  // namespace

extern "C" __attribute__((visibility("default"))) const eciton_plugin* eciton_dds_plugin(void) { return &kPlugin; }
