// Stands for one of Eciton's plugins: calls the vendor's library, and is called back by it.
#include <cstdlib>

extern "C" void fake_vendor_allocate();
extern "C" void fake_vendor_call(void (*back)());

extern "C" void fake_plugin_call_vendor() {
  fake_vendor_allocate();
  asm volatile("");  // no tail call: this frame must lie below the vendor's
}
extern "C" void fake_plugin_allocate_in_callback() {
  fake_vendor_call([] {
    void* volatile memory = std::malloc(100);
    std::free(memory);
  });
  asm volatile("");
}
