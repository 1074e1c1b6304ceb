// Cyclone DDS writes a line for every malformed packet it meets: a rogue peer could fill a disk, and slow the
// receive thread down to the pace of a terminal. Its log goes through a limit instead.
#pragma once

namespace eciton::bus::cyclonedds {

void limit_log();
void restore_log();

}  // namespace eciton::bus::cyclonedds
