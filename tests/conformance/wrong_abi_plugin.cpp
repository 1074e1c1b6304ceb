// A plugin of some other release: its ABI version is not ours.
#include "core/bus/plugin.h"

extern "C" const eciton_plugin* eciton_dds_plugin(void) {
  static eciton_plugin plugin{};
  plugin.abi_version = 999;
  plugin.struct_size = sizeof(eciton_plugin);
  return &plugin;
}
