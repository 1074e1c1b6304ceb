// LCM: UDP multicast, which it sends where the routing table says; a thread in lcm_handle. The domain separates runs.
#include <lcm/lcm.h>

#include <thread>

#include "benchmarks/latency/peers/raw_payload.hpp"
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/result.hpp"

namespace eciton::bench {
namespace {

class LcmTransport final : public Transport {
 public:
  LcmTransport(const PeerOptions& options, Sink& sink)
      : sink_(sink), own_(options.run + (options.role == Role::ping ? "_ping" : "_echo")) {
    const std::string url =
        "udpm://239.255.76.67:" + std::to_string(17'000 + options.domain) + "?ttl=1&recv_buf_size=1048576";
    lcm_ = ::lcm_create(url.c_str());
    if (lcm_ == nullptr) {
      throw BadInput{{"LCM cannot open " + url + ": it wants a route for multicast ('ip route add 224.0.0.0/4 dev " +
                      options.network_interface + "')"}};
    }
    const std::string others = options.run + (options.role == Role::ping ? "_echo" : "_ping");
    ::lcm_subscribe(lcm_, others.c_str(), &LcmTransport::on_message, this);
    std::thread([this] {
      while (::lcm_handle(lcm_) == 0) {
      }
    }).detach();
  }

  void select(std::uint32_t bytes) override { out_.resize(bytes); }
  bool send(const Mark& mark) noexcept override {
    const auto bytes = out_.with(mark);
    return ::lcm_publish(lcm_, own_.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) == 0;
  }

 private:
  static void on_message(const lcm_recv_buf_t* received, const char*, void* self) {
    give({static_cast<const std::byte*>(received->data), received->data_size},
         static_cast<LcmTransport*>(self)->sink_);
  }

  Sink& sink_;
  std::string own_;
  lcm_t* lcm_ = nullptr;
  RawPayload out_;
};

std::unique_ptr<Transport> make(const PeerOptions& options, Sink& sink) {
  return std::make_unique<LcmTransport>(options, sink);
}

}  // namespace
}  // namespace eciton::bench

int main(int argc, char** argv) { return eciton::bench::peer_main(argc, argv, eciton::bench::make); }
