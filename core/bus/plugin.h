/* The seam between Eciton and a DDS vendor: a plugin carries framework-made CDR bytes under their proper
 * type name and key hash. A C ABI, so that nothing of the STL crosses it; see docs/decisions/. */
#ifndef ECITON_CORE_BUS_PLUGIN_H
#define ECITON_CORE_BUS_PLUGIN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ECITON_PLUGIN_ABI_VERSION 3u
/* A plugin is lib<prefix><vendor>.so and exports one function of this name. */
#define ECITON_PLUGIN_PREFIX "eciton_dds_"
#define ECITON_PLUGIN_ENTRY "eciton_dds_plugin"

typedef struct eciton_type {
  const char* name;  /* DDS type name; outlives the endpoint */
  uint32_t size_max; /* greatest serialized size, encapsulation header included; a multiple of 4 */
  uint32_t key_size; /* bytes of the serialized key, at most 16; 0: no key */
  /* The 16-byte key hash (big-endian CDR of the key, zero-padded) of a sample, or with key_only of a
   * serialized key; both with encapsulation header, of either endianness. Returns 0 if malformed. */
  int (*key_hash)(const uint8_t* cdr, uint32_t size, int key_only, uint8_t hash[16]);
} eciton_type;

typedef struct eciton_qos {
  uint8_t reliable;
  uint8_t transient_local;
  uint32_t depth;         /* KEEP_LAST per instance */
  uint32_t instances_max; /* distinct keys; 1 without a key */
} eciton_qos;

typedef struct eciton_participant_config {
  uint32_t domain;
  const char* name;              /* for people and foreign tools */
  const char* network_interface; /* the one interface to use, as "lo" or "eth0" */
  const char* const* peers;      /* addresses for unicast discovery */
  uint32_t peer_count;           /* 0: multicast discovery on the interface */
  uint32_t lease_ms;             /* liveliness lease, equal on all participants of a domain */
} eciton_participant_config;

/* Receives one sample's bytes (encapsulation header included), valid during the call. */
typedef void (*eciton_sink)(void* context, const uint8_t* cdr, uint32_t size);

/* How a reader learns of its samples; both are called from a vendor's thread. */
typedef struct eciton_delivery {
  void (*signal)(void* context); /* there may be samples to take: it only wakes, never works */
  eciton_sink sample;            /* or else, unless NULL: is given every sample at once; take is not called */
  void* context;
} eciton_delivery;

/* What did not get as far as take, as far as the vendor tells. */
typedef struct eciton_reader_losses {
  uint64_t lost;     /* on the way, without a newer one in its place: missing numbers of a best-effort writer */
  uint64_t rejected; /* came, but malformed or over a bound; each time it came */
  uint64_t replaced; /* by a newer one of its key before it was taken: keep last, the reader's or the writer's */
} eciton_reader_losses;

typedef struct eciton_participant eciton_participant;
typedef struct eciton_writer eciton_writer;
typedef struct eciton_reader eciton_reader;

/* Creating functions return NULL and write a message (what, where, what would be right) into `error`.
 * write and take never block on the network, and allocate nothing outside the vendor's own library.
 * A reader is never given samples of writers of its own participant: the framework delivers those.
 * Any thread may ask for matched and losses. */
typedef struct eciton_plugin {
  uint32_t abi_version; /* ECITON_PLUGIN_ABI_VERSION */
  uint32_t struct_size; /* sizeof(eciton_plugin) */
  const char* vendor;   /* "fastdds" */
  const char* version;  /* of the vendor's library */

  eciton_participant* (*participant_create)(const eciton_participant_config* config, char* error,
                                            uint32_t error_size);
  void (*participant_destroy)(eciton_participant* participant); /* after its endpoints */

  eciton_writer* (*writer_create)(eciton_participant* participant, const char* topic, const eciton_type* type,
                                  const eciton_qos* qos, char* error, uint32_t error_size);
  void (*writer_destroy)(eciton_writer* writer);
  int (*writer_write)(eciton_writer* writer, const uint8_t* cdr, uint32_t size); /* 1: accepted */
  uint32_t (*writer_matched)(eciton_writer* writer);                             /* readers matched now */

  eciton_reader* (*reader_create)(eciton_participant* participant, const char* topic, const eciton_type* type,
                                  const eciton_qos* qos, eciton_delivery delivery, char* error, uint32_t error_size);
  void (*reader_destroy)(eciton_reader* reader); /* no signal after it returns */
  uint32_t (*reader_take)(eciton_reader* reader, uint32_t count_max, eciton_sink sink,
                          void* context); /* samples given */
  uint32_t (*reader_matched)(eciton_reader* reader);
  void (*reader_losses)(eciton_reader* reader, eciton_reader_losses* losses); /* since it was created */
  /* Within the sink: which participant wrote the sample it is given, by a number that all its writers share and no
   * other has; 0: not known, as in one process it may be. */
  uint64_t (*reader_origin)(eciton_reader* reader);
} eciton_plugin;

const eciton_plugin* eciton_dds_plugin(void);

#ifdef __cplusplus
}
#endif

#endif
