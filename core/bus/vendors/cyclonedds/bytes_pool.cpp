// Size-class pool; each lock is held for a few instructions, never across an allocation.
#include "core/bus/vendors/cyclonedds/bytes_pool.hpp"

#include <cstdlib>
#include <mutex>

namespace eciton::bus::cyclonedds {

InheritingMutex::InheritingMutex() {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_init(&mutex_, &attributes);
  pthread_mutexattr_destroy(&attributes);
}

BytesPool& BytesPool::instance() {
  static BytesPool pool;
  return pool;
}

std::size_t BytesPool::class_of(std::size_t size) {
  std::size_t size_class = 0;
  while (size_class < kClasses && capacity(size_class) < size) ++size_class;
  return size_class;
}

BytesPool::Block* BytesPool::allocate(std::size_t size_class) {
  const std::size_t bytes = sizeof(Block) + capacity(size_class);
  if (bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes > kBytesMax) {
    bytes_.fetch_sub(bytes, std::memory_order_relaxed);
    return nullptr;
  }
  auto* block = static_cast<Block*>(std::calloc(1, bytes));
  if (block == nullptr) {
    bytes_.fetch_sub(bytes, std::memory_order_relaxed);
    return nullptr;
  }
  block->size_class = size_class;
  SizeClass& of = classes_[size_class];
  const std::lock_guard<InheritingMutex> lock(of.mutex);
  ++of.blocks;
  return block;
}

void BytesPool::put_back(Block* block) {
  SizeClass& of = classes_[block->size_class];
  const std::lock_guard<InheritingMutex> lock(of.mutex);
  block->next = of.free;
  of.free = block;
}

bool BytesPool::reserve(std::size_t size, std::size_t count) {
  const std::size_t size_class = class_of(size);
  if (size_class == kClasses) return false;
  SizeClass& of = classes_[size_class];
  std::size_t missing = 0;
  {
    const std::lock_guard<InheritingMutex> lock(of.mutex);
    of.reserved += count;
    missing = of.reserved > of.blocks ? of.reserved - of.blocks : 0;
  }
  for (; missing > 0; --missing) {
    Block* block = allocate(size_class);
    if (block == nullptr) {
      unreserve(size, count);
      return false;
    }
    put_back(block);
  }
  return true;
}

void BytesPool::unreserve(std::size_t size, std::size_t count) {
  SizeClass& of = classes_[class_of(size)];
  const std::lock_guard<InheritingMutex> lock(of.mutex);
  of.reserved -= count;
}

void* BytesPool::acquire(std::size_t size) {
  const std::size_t size_class = class_of(size);
  if (size_class == kClasses) return nullptr;
  SizeClass& of = classes_[size_class];
  Block* block = nullptr;
  {
    const std::lock_guard<InheritingMutex> lock(of.mutex);
    block = of.free;
    if (block != nullptr) of.free = block->next;
  }
  if (block == nullptr) block = allocate(size_class);
  return block == nullptr ? nullptr : block + 1;
}

void BytesPool::release(void* block) { instance().put_back(static_cast<Block*>(block) - 1); }

void BytesPool::trim() {
  for (std::size_t k = 0; k < kClasses; ++k) {
    Block* list = nullptr;
    {
      const std::lock_guard<InheritingMutex> lock(classes_[k].mutex);
      list = classes_[k].free;
      classes_[k].free = nullptr;
      for (const Block* block = list; block != nullptr; block = block->next) --classes_[k].blocks;
    }
    while (list != nullptr) {
      Block* next = list->next;
      std::free(list);
      list = next;
      bytes_.fetch_sub(sizeof(Block) + capacity(k), std::memory_order_relaxed);
    }
  }
}

}  // namespace eciton::bus::cyclonedds
