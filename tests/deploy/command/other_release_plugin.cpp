// A vendor's plugin of another release of Eciton: the right file name and entry, another ABI.
#include "core/bus/plugin.h"

extern "C" const eciton_plugin* eciton_dds_plugin(void) {
  static eciton_plugin plugin{};
  plugin.abi_version = ECITON_PLUGIN_ABI_VERSION + 1;
  plugin.struct_size = sizeof(eciton_plugin);
  return &plugin;
}
