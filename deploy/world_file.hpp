// What `eciton-world` reads: the world, and how it is served.
#pragma once

#include <string>

#include "core/base/config.hpp"
#include "hal/sim/world_config.hpp"

namespace eciton::deploy {

struct WorldFile {
  std::string socket;
  std::string pace = "lockstep";  // or wall
  double tick_s = 0.002;
  bool truth = true;               // publish truth_pose and truth_contact on the module rings
  std::string net;                 // publish it in the modules' hosts of this net; empty: here
  std::string dds = "cyclonedds";  // vendor of the truth's participants
  std::string airframe = "legion";
  hal::sim::WorldConfig world;

  template <class V>
  void visit_fields(V& v) {
    v("socket", socket);
    v("pace", pace, one_of({"lockstep", "wall"}));
    v("tick_s", tick_s, in_range(0.001, 0.01));
    v("truth", truth);
    v("net", net);
    v("dds", dds);
    v("airframe", airframe, one_of({"legion", "legion-lidar"}));
    v("world", world);
  }
};

}  // namespace eciton::deploy
