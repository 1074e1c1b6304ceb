// The function tables of the byte-carrying type. They run in the vendor's threads and in write and take:
// no allocation but from the pool, and no trust in what came from the network.
#include "core/bus/vendors/cyclonedds/bytes_type.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

#include "core/bus/vendors/cyclonedds/bytes_pool.hpp"
#include "core/bus/vendors/request.hpp"

namespace eciton::bus::cyclonedds {
namespace {

using vendors::kHeaderSize;

// A serialized key: its bytes, and padding between members of an 8-byte alignment.
constexpr std::uint32_t kKeyPayloadMax = kHeaderSize + 32;

BytesSerdata* as_bytes(ddsi_serdata* serdata) { return static_cast<BytesSerdata*>(serdata); }
const BytesSerdata* as_bytes(const ddsi_serdata* serdata) { return static_cast<const BytesSerdata*>(serdata); }
const eciton_type& type_of(const ddsi_sertype* sertype) { return static_cast<const BytesSertype*>(sertype)->type; }

constexpr std::size_t padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

/// Room for `size` bytes, the padding to a multiple of 4 that goes on the wire set to zero.
BytesSerdata* new_serdata(const ddsi_sertype* sertype, ddsi_serdata_kind kind, std::size_t size) {
  // Of the class that was reserved: a short string or sequence must not ask for blocks of another.
  const std::size_t block =
      kind == SDK_KEY ? sizeof(BytesSerdata) + padded(size) : sample_block_size(type_of(sertype));
  void* memory = BytesPool::instance().acquire(block);
  if (memory == nullptr) return nullptr;
  auto* serdata = new (memory) BytesSerdata{};
  ddsi_serdata_init(serdata, sertype, kind);
  serdata->size = static_cast<std::uint32_t>(size);
  std::memset(serdata->cdr() + size, 0, padded(size) - size);
  return serdata;
}

void set_hash(BytesSerdata& serdata) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const std::uint8_t byte : serdata.key_hash) hash = (hash ^ byte) * 16777619u;
  serdata.hash = hash;
}

/// The serdata with its key hash, or null (and the block given back) if its bytes are no sample of the type.
ddsi_serdata* finished(BytesSerdata* serdata) {
  const eciton_type& type = type_of(serdata->type);
  const bool key_only = serdata->kind == SDK_KEY;
  const bool good =
      key_only ? serdata->size >= kHeaderSize : vendors::well_formed(type, serdata->cdr(), serdata->size);
  if (!good || !vendors::key_hash_of(type, serdata->cdr(), serdata->size, key_only, serdata->key_hash)) {
    BytesPool::release(serdata);
    return nullptr;
  }
  set_hash(*serdata);
  return serdata;
}

bool fits(const ddsi_sertype* sertype, ddsi_serdata_kind kind, std::size_t size) {
  return size >= kHeaderSize && size <= (kind == SDK_KEY ? kKeyPayloadMax : type_of(sertype).size_max);
}

bool equal_keys(const ddsi_serdata* a, const ddsi_serdata* b) {
  return std::memcmp(as_bytes(a)->key_hash, as_bytes(b)->key_hash, sizeof(BytesSerdata::key_hash)) == 0;
}

std::uint32_t size_of(const ddsi_serdata* serdata) { return as_bytes(serdata)->size; }

/// The vendor keeps this to itself, but its packets are there: by RTPS, the header has the participant's part of the
/// GUID at byte 8, and a DATA or DATA_FRAG submessage the writer's at byte 12 and its number at 16, high half first.
Origin origin_of(const nn_rdata* fragment) {
  Origin origin;
  if (NN_RDATA_SUBMSG_OFF(fragment) == 0) return origin;
  const unsigned char* packet = NN_RMSG_PAYLOAD(fragment->rmsg);
  const unsigned char* submessage = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_SUBMSG_OFF(fragment));
  const bool little_endian = (submessage[1] & 1) != 0;
  std::memcpy(origin.writer.data(), packet + 8, 12);
  std::memcpy(origin.writer.data() + 12, submessage + 12, 4);
  std::uint64_t number = 0;
  for (const unsigned half : {16u, 20u}) {
    for (unsigned k = 0; k < 4; ++k) number = number << 8 | submessage[half + (little_endian ? 3 - k : k)];
  }
  origin.number = static_cast<std::int64_t>(number);
  return origin;
}

ddsi_serdata* from_fragments(const ddsi_sertype* sertype, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  if (!fits(sertype, kind, size)) return nullptr;
  BytesSerdata* serdata = new_serdata(sertype, kind, size);
  if (serdata == nullptr) return nullptr;
  serdata->origin = origin_of(fragment);
  std::uint32_t copied = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= copied) continue;  // fragments may overlap
    const std::uint32_t end = std::min<std::uint32_t>(fragment->maxp1, serdata->size);
    if (fragment->min > copied || end <= copied) break;
    const unsigned char* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(serdata->cdr() + copied, payload + (copied - fragment->min), end - copied);
    copied = end;
  }
  if (copied < serdata->size) {
    BytesPool::release(serdata);
    return nullptr;
  }
  return finished(serdata);
}

ddsi_serdata* from_buffers(const ddsi_sertype* sertype, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                           const ddsrt_iovec_t* buffers, std::size_t size) {
  if (!fits(sertype, kind, size)) return nullptr;
  BytesSerdata* serdata = new_serdata(sertype, kind, size);
  if (serdata == nullptr) return nullptr;
  std::size_t copied = 0;
  for (ddsrt_msg_iovlen_t k = 0; k < count && copied < size; ++k) {
    const std::size_t length = std::min<std::size_t>(buffers[k].iov_len, size - copied);
    std::memcpy(serdata->cdr() + copied, buffers[k].iov_base, length);
    copied += length;
  }
  std::memset(serdata->cdr() + copied, 0, size - copied);
  return finished(serdata);
}

/// A serialized key in big-endian order: the key hash is just that, padded.
ddsi_serdata* from_key_hash(const ddsi_sertype* sertype, const ddsi_keyhash* hash) {
  const std::uint32_t key_size = type_of(sertype).key_size;
  BytesSerdata* serdata = new_serdata(sertype, SDK_KEY, kHeaderSize + key_size);
  if (serdata == nullptr) return nullptr;
  std::memset(serdata->cdr(), 0, kHeaderSize);
  std::memcpy(serdata->cdr() + kHeaderSize, hash->value, key_size);
  if (key_size > 0) std::memcpy(serdata->key_hash, hash->value, sizeof serdata->key_hash);
  set_hash(*serdata);
  return serdata;
}

ddsi_serdata* from_sample(const ddsi_sertype* sertype, ddsi_serdata_kind kind, const void* sample) {
  const auto* bytes = static_cast<const Bytes*>(sample);
  if (kind == SDK_DATA) {
    if (!fits(sertype, kind, bytes->size)) return nullptr;
    BytesSerdata* serdata = new_serdata(sertype, kind, bytes->size);
    if (serdata == nullptr) return nullptr;
    std::memcpy(serdata->cdr(), bytes->cdr, bytes->size);
    return finished(serdata);
  }
  ddsi_keyhash hash;
  if (!vendors::key_hash_of(type_of(sertype), bytes->cdr, bytes->size, false, hash.value)) return nullptr;
  return from_key_hash(sertype, &hash);
}

void copy_out(const ddsi_serdata* serdata, std::size_t offset, std::size_t size, void* to) {
  std::memcpy(to, as_bytes(serdata)->cdr() + offset, size);
}

ddsi_serdata* lend(const ddsi_serdata* serdata, std::size_t offset, std::size_t size, ddsrt_iovec_t* to) {
  to->iov_base = const_cast<std::uint8_t*>(as_bytes(serdata)->cdr()) + offset;
  to->iov_len = size;
  return ddsi_serdata_ref(serdata);
}

void take_back(ddsi_serdata* serdata, const ddsrt_iovec_t*) { ddsi_serdata_unref(serdata); }

bool to_sample(const ddsi_serdata* serdata, void* sample, void**, void*) {
  if (sample == nullptr) return false;
  *static_cast<Bytes*>(sample) = {as_bytes(serdata)->cdr(), as_bytes(serdata)->size, &as_bytes(serdata)->origin};
  return true;
}

/// What stands for a key in the vendor's table of instances: only the hash.
ddsi_serdata* to_untyped(const ddsi_serdata* serdata) {
  BytesSerdata* key = new_serdata(serdata->type, SDK_KEY, 0);
  if (key == nullptr) return nullptr;
  std::memcpy(key->key_hash, as_bytes(serdata)->key_hash, sizeof key->key_hash);
  key->hash = serdata->hash;
  key->type = nullptr;  // shared by all types, outlives them
  return key;
}

bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void* sample, void**, void*) {
  *static_cast<Bytes*>(sample) = {};
  return true;
}

void free_serdata(ddsi_serdata* serdata) {
  // The vendor's own counting orders this after all use; the thread sanitizer sees of it only what is inline in ours.
  static_cast<void>(__atomic_load_n(&serdata->refc.v, __ATOMIC_ACQUIRE));
  BytesPool::release(as_bytes(serdata));
}

std::size_t print(const ddsi_sertype*, const ddsi_serdata* serdata, char* text, std::size_t size) {
  return static_cast<std::size_t>(std::snprintf(text, size, "<%u bytes of CDR>", as_bytes(serdata)->size));
}

void get_key_hash(const ddsi_serdata* serdata, ddsi_keyhash* hash, bool) {
  std::memcpy(hash->value, as_bytes(serdata)->key_hash, sizeof hash->value);
}

// Shared memory is off: these two are there because the struct has them.
std::uint32_t shared_memory_size(const ddsi_serdata* serdata) { return as_bytes(serdata)->size; }
ddsi_serdata* from_shared_memory(const ddsi_sertype*, ddsi_serdata_kind, void*, void*) { return nullptr; }

const ddsi_serdata_ops kSerdataOps = {
    equal_keys,   size_of, from_fragments, from_buffers,       from_key_hash,      from_sample,
    copy_out,     lend,    take_back,      to_sample,          to_untyped,         untyped_to_sample,
    free_serdata, print,   get_key_hash,   shared_memory_size, from_shared_memory,
};

void free_sertype(ddsi_sertype* sertype) {
  ddsi_sertype_fini(sertype);
  delete static_cast<BytesSertype*>(sertype);
}

void zero_samples(const ddsi_sertype*, void* samples, std::size_t count) {
  std::fill_n(static_cast<Bytes*>(samples), count, Bytes{});
}

// The vendor asks for samples of its own only to show them to the reader's filter, one at a time.
void realloc_samples(void** samples, const ddsi_sertype*, void* old, std::size_t old_count, std::size_t count) {
  auto* block = static_cast<Bytes*>(BytesPool::instance().acquire(count * sizeof(Bytes)));
  if (block != nullptr) std::fill_n(block, count, Bytes{});
  if (block != nullptr && old != nullptr) std::copy_n(static_cast<Bytes*>(old), std::min(old_count, count), block);
  if (old != nullptr) BytesPool::release(old);
  for (std::size_t k = 0; k < count; ++k) samples[k] = block == nullptr ? nullptr : block + k;
}

void free_samples(const ddsi_sertype*, void** samples, std::size_t count, dds_free_op_t operation) {
  if (count > 0 && samples[0] != nullptr && (operation & DDS_FREE_ALL_BIT) != 0) BytesPool::release(samples[0]);
}

bool equal_types(const ddsi_sertype* a, const ddsi_sertype* b) {
  const eciton_type& x = type_of(a);
  const eciton_type& y = type_of(b);
  return x.key_hash == y.key_hash && x.size_max == y.size_max && x.key_size == y.key_size;
}

std::uint32_t hash_type(const ddsi_sertype* sertype) { return type_of(sertype).size_max; }

std::size_t serialized_size(const ddsi_sertype*, const void* sample) {
  return static_cast<const Bytes*>(sample)->size;
}

bool serialize_into(const ddsi_sertype*, const void* sample, void* to, std::size_t size) {
  const auto* bytes = static_cast<const Bytes*>(sample);
  if (size < bytes->size) return false;
  std::memcpy(to, bytes->cdr, bytes->size);
  return true;
}

const ddsi_sertype_ops kSertypeOps = {
    ddsi_sertype_v0, nullptr, free_sertype, zero_samples, realloc_samples, free_samples,    equal_types,
    hash_type,       nullptr, nullptr,      nullptr,      nullptr,         serialized_size, serialize_into,
};

}  // namespace

ddsi_sertype* new_bytes_sertype(const eciton_type& type) {
  auto* sertype = new BytesSertype{};
  // No key hash is asked for: the leading members are the key, and each sample would be 24 bytes larger for it.
  ddsi_sertype_init_flags(sertype, type.name, &kSertypeOps, &kSerdataOps,
                          type.key_size > 0 ? 0 : DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  sertype->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  sertype->type = type;
  sertype->type.name = sertype->type_name;
  return sertype;
}

std::size_t sample_block_size(const eciton_type& type) { return sizeof(BytesSerdata) + padded(type.size_max); }

}  // namespace eciton::bus::cyclonedds
