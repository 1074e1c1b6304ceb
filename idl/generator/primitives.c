// The primitive types of the wire contract: one row each, from idlc's type to size, C++ and IDL. Types
// that idlc spells in two ways (long, int32) are reprinted in the one that shows the width.
#include "idl/generator/generator.h"

static const primitive_t primitives[] = {
    {IDL_BOOL, 1, "bool", "boolean"},           {IDL_CHAR, 1, "char", "char"},
    {IDL_OCTET, 1, "std::uint8_t", "octet"},    {IDL_INT8, 1, "std::int8_t", "int8"},
    {IDL_UINT8, 1, "std::uint8_t", "uint8"},    {IDL_SHORT, 2, "std::int16_t", "int16"},
    {IDL_INT16, 2, "std::int16_t", "int16"},    {IDL_USHORT, 2, "std::uint16_t", "uint16"},
    {IDL_UINT16, 2, "std::uint16_t", "uint16"}, {IDL_LONG, 4, "std::int32_t", "int32"},
    {IDL_INT32, 4, "std::int32_t", "int32"},    {IDL_ULONG, 4, "std::uint32_t", "uint32"},
    {IDL_UINT32, 4, "std::uint32_t", "uint32"}, {IDL_LLONG, 8, "std::int64_t", "int64"},
    {IDL_INT64, 8, "std::int64_t", "int64"},    {IDL_ULLONG, 8, "std::uint64_t", "uint64"},
    {IDL_UINT64, 8, "std::uint64_t", "uint64"}, {IDL_FLOAT, 4, "float", "float"},
    {IDL_DOUBLE, 8, "double", "double"},
};

const primitive_t* find_primitive(const idl_type_spec_t* type) {
  for (size_t k = 0; k < sizeof primitives / sizeof *primitives; ++k) {
    if (primitives[k].type == idl_type(type)) return &primitives[k];
  }
  return NULL;
}
