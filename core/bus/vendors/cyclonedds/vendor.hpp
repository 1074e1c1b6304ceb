// Every header of Cyclone DDS that the plugin uses, in the one order that compiles as C++.
#pragma once

// Lies in the multiarch include directory; without it structs below silently change their size.
#include <dds/features.h>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#undef restrict  // defined by dds.h for C++ too

// The plugin fills these structs itself: the layout is that of the packaged 0.10.2.
static_assert(sizeof(void*) == 8);
static_assert(sizeof(ddsi_sertype) == 80 && sizeof(ddsi_serdata) == 72 && sizeof(ddsi_serdata_ops) == 136);
