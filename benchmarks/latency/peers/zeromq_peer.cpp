// ZeroMQ over TCP, a pipe each way: PUSH to PULL, one I/O thread, a thread blocked in receive.
#include <zmq.h>

#include <thread>

#include "benchmarks/latency/peers/raw_payload.hpp"
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/result.hpp"
#include "core/bus/vendors/network.hpp"

namespace eciton::bench {
namespace {

class ZeromqTransport final : public Transport {
 public:
  ZeromqTransport(const PeerOptions& options, Sink& sink)
      : sink_(sink), context_(::zmq_ctx_new()), in_(::zmq_socket(context_, ZMQ_PULL)) {
    out_socket_ = ::zmq_socket(context_, ZMQ_PUSH);
    const std::string own = value_or_throw(bus::vendors::interface_address(options.network_interface));
    if (::zmq_bind(in_, ("tcp://" + own + ":*").c_str()) != 0) {
      throw BadInput{{"ZeroMQ cannot bind to " + own + ": " + ::zmq_strerror(::zmq_errno())}};
    }
    std::size_t size = sizeof address_;
    ::zmq_getsockopt(in_, ZMQ_LAST_ENDPOINT, address_, &size);
    std::thread([this] { receive_all(); }).detach();
  }

  std::string address() const override { return address_; }
  void connect(const std::string& address) override { ::zmq_connect(out_socket_, address.c_str()); }
  void select(std::uint32_t bytes) override { out_.resize(bytes); }
  bool send(const Mark& mark) noexcept override {
    const auto bytes = out_.with(mark);
    return ::zmq_send(out_socket_, bytes.data(), bytes.size(), ZMQ_DONTWAIT) >= 0;
  }

 private:
  void receive_all() {
    std::array<std::byte, payload_sizes.back()> in;
    for (;;) {
      const int size = ::zmq_recv(in_, in.data(), in.size(), 0);
      if (size > 0) give({in.data(), static_cast<std::size_t>(size)}, sink_);
    }
  }

  Sink& sink_;
  void* context_;
  void* in_;
  void* out_socket_;
  char address_[128] = "-";
  RawPayload out_;
};

std::unique_ptr<Transport> make(const PeerOptions& options, Sink& sink) {
  return std::make_unique<ZeromqTransport>(options, sink);
}

}  // namespace
}  // namespace eciton::bench

int main(int argc, char** argv) { return eciton::bench::peer_main(argc, argv, eciton::bench::make); }
