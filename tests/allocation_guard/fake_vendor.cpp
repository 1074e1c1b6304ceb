// Stands for a DDS vendor's library: allocates by itself, and calls back into a plugin.
#include <cstdlib>

extern "C" void fake_vendor_allocate() {
  void* volatile memory = std::malloc(100);
  std::free(memory);
}
extern "C" void fake_vendor_call(void (*back)()) {
  back();
  asm volatile("");  // no tail call: the callback must have this frame below it
}
