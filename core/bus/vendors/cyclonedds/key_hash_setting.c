// The one setting of a running domain that the plugin changes. In C: the vendor's header is not C++.
#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/features.h>

void eciton_cyclonedds_set_key_hashes(struct ddsi_domaingv* domain, int on);
void eciton_cyclonedds_set_key_hashes(struct ddsi_domaingv* domain, int on) { domain->config.generate_keyhash = on; }
