// Interfaces by ioctl. Neighbours are entered by hand, so that no ARP is on the air: what the radio carries and
// loses is what the programs send.
#include "deploy/net/tap.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace eciton::net {
namespace {

constexpr int transmit_queue_frames = 1000;
constexpr MacAddress mac_prefix{0x02, 'e', 'c', 'n', 0, 0};  // locally administered

ifreq request_for(const char* interface) {
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  return request;
}

sockaddr ipv4(const std::string& address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  ::inet_pton(AF_INET, address.c_str(), &in.sin_addr);
  sockaddr result{};
  std::memcpy(&result, &in, sizeof in);
  return result;
}

sockaddr hardware(const MacAddress& mac) {
  sockaddr result{};
  result.sa_family = ARPHRD_ETHER;
  std::memcpy(result.sa_data, mac.data(), mac.size());
  return result;
}

/// Keeps the first failure of a row of ioctls.
class Configuration {
 public:
  Configuration() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (socket_ < 0) note("a socket", errno);
  }
  ~Configuration() {
    if (socket_ >= 0) ::close(socket_);
  }
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  template <class Request>
  void set(const char* what, unsigned long code, Request request) {
    if (status_ && ::ioctl(socket_, code, &request) != 0) note(what, errno);
  }
  void raise(const char* interface, short flags) {
    ifreq request = request_for(interface);
    if (status_ && ::ioctl(socket_, SIOCGIFFLAGS, &request) != 0) note("flags", errno);
    request.ifr_flags = static_cast<short>(request.ifr_flags | flags);
    set("flags", SIOCSIFFLAGS, request);
  }
  const Status& status() const { return status_; }

 private:
  void note(const char* what, int why) { status_ = Error{std::string(what) + ": " + std::strerror(why)}; }

  int socket_;
  Status status_ = ok();
};

/// Neighbour and router discovery of IPv6 would be on the air too. Where there is no IPv6 there is nothing to do.
void keep_ipv6_off() {
  for (const char* file :
       {"/proc/sys/net/ipv6/conf/all/disable_ipv6", "/proc/sys/net/ipv6/conf/default/disable_ipv6"}) {
    const int fd = ::open(file, O_WRONLY | O_CLOEXEC);
    if (fd < 0) continue;
    [[maybe_unused]] const auto written = ::write(fd, "1", 1);
    ::close(fd);
  }
}

/// With the routes and neighbours that go when an interface loses its address.
void configure_address(Configuration& configuration, std::uint32_t index, std::uint32_t modules,
                       const std::string& address) {
  ifreq request = request_for(radio_interface);
  request.ifr_addr = ipv4(address);
  configuration.set("address", SIOCSIFADDR, request);
  request.ifr_netmask = ipv4("255.255.255.0");
  configuration.set("netmask", SIOCSIFNETMASK, request);
  configuration.raise(radio_interface, IFF_UP | IFF_MULTICAST);
  std::string device = radio_interface;
  rtentry route{};
  route.rt_dst = ipv4("224.0.0.0");
  route.rt_genmask = ipv4("240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = device.data();
  configuration.set("multicast route", SIOCADDRT, route);
  for (std::uint32_t other = 0; other <= modules; ++other) {
    if (other == index) continue;
    arpreq neighbour{};
    neighbour.arp_ha = hardware(host_mac(other));
    neighbour.arp_flags = ATF_PERM | ATF_COM;
    std::strncpy(neighbour.arp_dev, radio_interface, sizeof neighbour.arp_dev - 1);
    for (const std::string& its : {host_address(other), moved_address(other)}) {
      neighbour.arp_pa = ipv4(its);
      configuration.set("neighbour", SIOCSARP, neighbour);
    }
  }
}

Status configure(std::uint32_t index, std::uint32_t modules) {
  Configuration configuration;
  configuration.raise("lo", IFF_UP | IFF_MULTICAST);
  ifreq request = request_for(radio_interface);
  request.ifr_hwaddr = hardware(host_mac(index));
  configuration.set("hardware address", SIOCSIFHWADDR, request);
  request.ifr_qlen = transmit_queue_frames;
  configuration.set("queue length", SIOCSIFTXQLEN, request);
  configure_address(configuration, index, modules, host_address(index));
  return configuration.status();
}

}  // namespace

Status set_address(const std::string& net, std::uint32_t index, std::uint32_t modules, const std::string& address) {
  const InNamespace inside(host_namespace(net, index));
  Configuration configuration;
  configure_address(configuration, index, modules, address);
  if (configuration.status()) return ok();
  return Error{"host " + host_name(index) + " of net " + net + ": " + configuration.status().error().message};
}

MacAddress host_mac(std::uint32_t index) {
  MacAddress mac = mac_prefix;
  mac[5] = static_cast<std::uint8_t>(index);
  return mac;
}

std::optional<std::uint32_t> host_with_mac(const std::uint8_t* mac, std::uint32_t modules) {
  if (!std::equal(mac_prefix.begin(), mac_prefix.end() - 1, mac) || mac[5] > modules) return std::nullopt;
  return mac[5];
}

Result<Tap> Tap::open(const std::string& net, std::uint32_t index, std::uint32_t modules) {
  const InNamespace inside(host_namespace(net, index));
  keep_ipv6_off();
  const std::string where = "host " + host_name(index) + " of net " + net + ": ";
  const int fd = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return Error{where + "/dev/net/tun: " + std::strerror(errno)};
  Tap tap(fd);
  ifreq request = request_for(radio_interface);
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  if (::ioctl(fd, TUNSETIFF, &request) != 0)
    return Error{where + "no TAP device " + radio_interface + " can be made: " + std::strerror(errno)};
  if (const Status status = configure(index, modules); !status) {
    return Error{where + radio_interface + " cannot be configured: " + status.error().message};
  }
  return tap;
}

Tap::~Tap() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace eciton::net
