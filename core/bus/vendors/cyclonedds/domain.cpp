// The registry of open domains, and the configuration each is opened with.
#include "core/bus/vendors/cyclonedds/domain.hpp"

#include <map>
#include <mutex>
#include <sstream>

#include "core/bus/vendors/cyclonedds/bytes_pool.hpp"
#include "core/bus/vendors/cyclonedds/log.hpp"
#include "core/bus/vendors/cyclonedds/vendor.hpp"
#include "core/bus/vendors/network.hpp"

extern "C" void eciton_cyclonedds_set_key_hashes(ddsi_domaingv* domain, int on);  // key_hash_setting.c

namespace eciton::bus::cyclonedds {
namespace {

struct Settings {
  std::string network_interface;
  std::string address;
  std::vector<std::string> peers;
  std::uint32_t lease_ms = 0;
  std::uint32_t domain = 0;
};

struct OpenDomain {
  Settings settings;
  dds_entity_t entity = 0;
  std::uint32_t participants = 0;
};

struct Registry {
  std::mutex mutex;
  std::map<std::uint32_t, OpenDomain> domains;
};

Registry& registry() {
  static Registry open;
  return open;
}

// Given as text to dds_create_domain, so CYCLONEDDS_URI is not looked at.
std::string configuration(const Settings& settings) {
  const bool multicast = settings.peers.empty();
  std::ostringstream xml;
  xml << "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface address=\"" << settings.address
      << "\" multicast=\"" << (multicast ? "true" : "false") << "\"/></Interfaces><AllowMulticast>"
      << (multicast ? "spdp" : "false") << "</AllowMulticast></General><Discovery>";
  if (!multicast) {
    const vendors::UnicastRange range = vendors::unicast_range(settings.peers);
    xml << "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>" << range.participants - 1
        << "</MaxAutoParticipantIndex><Peers>";
    const std::string port =  // without one: all that participants may have
        range.announced_to == 1 ? ":" + std::to_string(vendors::first_discovery_port(settings.domain)) : "";
    for (const std::string& peer : settings.peers) xml << "<Peer Address=\"" << peer << port << "\"/>";
    xml << "</Peers>";
  }
  const vendors::AnnouncementPace pace = vendors::announcement_pace(settings.lease_ms, settings.peers);
  xml << "<SPDPInterval>" << pace.period_ms << "ms</SPDPInterval><LeaseDuration>" << pace.lease_ms
      << "ms</LeaseDuration></Discovery><Internal>"
      // One receive thread, so that a scheduling policy set by the creating thread covers all of them.
      << "<MultipleReceiveThreads>false</MultipleReceiveThreads>"
      // Fast DDS reads the key of what Cyclone disposes (endpoints that go, above all) from the key hash only; for
      // samples it is turned off: WithoutKeyHashes.
      << "<GenerateKeyhash>true</GenerateKeyhash>"
      // A reliable writer being deleted waits this long for acknowledgements (default 1 s).
      << "<WriterLingerDuration>20ms</WriterLingerDuration>"
      // The defaults (100 ms doubling to 8 s, 100 ms, 3 s) leave gaps of seconds after a loss; Fast DDS is set to the
      // same.
      << "<HeartbeatInterval min=\"5ms\" minsched=\"5ms\" max=\"200ms\">10ms</HeartbeatInterval>"
      << "<NackDelay>5ms</NackDelay><AutoReschedNackDelay>50ms</AutoReschedNackDelay>"
      // KEEP_LAST bounds what a writer holds; waiting at a watermark below that would block a step.
      << "<Watermarks><WhcHigh>16MiB</WhcHigh><WhcHighInit>16MiB</WhcHighInit><WhcAdaptive>false</WhcAdaptive>"
      << "</Watermarks></Internal></Domain></CycloneDDS>";
  return xml.str();
}

std::string described(const Settings& settings) {
  std::string text = "interface " + settings.network_interface + " (" + settings.address + "), lease " +
                     std::to_string(settings.lease_ms) + " ms, ";
  if (settings.peers.empty()) return text + "multicast";
  text += "peers";
  for (const std::string& peer : settings.peers) text += " " + peer;
  return text;
}

Result<Settings> settings_of(const eciton_participant_config& config) {
  Result<std::string> address = vendors::interface_address(config.network_interface);
  if (!address) return address.error();
  Result<std::vector<std::string>> peers = vendors::peer_addresses(config.peers, config.peer_count);
  if (!peers) return peers.error();
  return Settings{config.network_interface, *address, *peers, config.lease_ms, config.domain};
}

}  // namespace

Result<SharedDomain> SharedDomain::acquire(const eciton_participant_config& config) {
  const Result<Settings> asked = settings_of(config);
  if (!asked) return asked.error();
  const std::string wanted = described(*asked);
  const std::lock_guard<std::mutex> lock(registry().mutex);
  auto& domains = registry().domains;
  if (const auto found = domains.find(config.domain); found != domains.end()) {
    const std::string open = described(found->second.settings);
    if (open != wanted) {
      return Error{"participant \"" + std::string(config.name) + "\": domain " + std::to_string(config.domain) +
                   " is open in this process with " + open + ", not with " + wanted +
                   "; Cyclone DDS has one configuration per domain and process"};
    }
    ++found->second.participants;
    return SharedDomain(config.domain);
  }
  if (domains.empty()) limit_log();
  const dds_entity_t entity = dds_create_domain(config.domain, configuration(*asked).c_str());
  if (entity < 0) {
    return Error{"participant \"" + std::string(config.name) + "\": Cyclone DDS cannot open domain " +
                 std::to_string(config.domain) + " with " + wanted + ": " + dds_strretcode(-entity)};
  }
  domains[config.domain] = {*asked, entity, 1};
  return SharedDomain(config.domain);
}

WithoutKeyHashes::WithoutKeyHashes(const ddsi_sertype& registered)
    : lock_(mutex()), domain_(static_cast<ddsi_domaingv*>(ddsrt_atomic_ldvoidp(&registered.gv))) {
  eciton_cyclonedds_set_key_hashes(domain_, 0);
}

WithoutKeyHashes::~WithoutKeyHashes() { eciton_cyclonedds_set_key_hashes(domain_, 1); }

std::mutex& WithoutKeyHashes::mutex() {
  static std::mutex one;
  return one;
}

SharedDomain::~SharedDomain() {
  if (!held_) return;
  const std::lock_guard<std::mutex> lock(registry().mutex);
  auto& domains = registry().domains;
  const auto found = domains.find(id_);
  if (--found->second.participants > 0) return;
  dds_delete(found->second.entity);
  domains.erase(found);
  if (!domains.empty()) return;
  BytesPool::instance().trim();
  restore_log();
}

}  // namespace eciton::bus::cyclonedds
