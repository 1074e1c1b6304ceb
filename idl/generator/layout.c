// Sizes on the wire: plain CDR as in XCDR version 1, everything aligned to its own size from the end of
// the encapsulation header on. Where an element ends grows with where it starts, so full bounds are greatest.
#include "idl/generator/generator.h"

static size_t align(size_t offset, size_t alignment) { return (offset + alignment - 1) / alignment * alignment; }

static size_t end_of_struct(const idl_struct_t* node, size_t offset);

static size_t end_of(const idl_type_spec_t* type, size_t offset) {
  const primitive_t* primitive = find_primitive(type);
  if (primitive) return align(offset, primitive->size) + primitive->size;
  if (idl_is_enum(type)) return align(offset, 4) + 4;
  if (idl_is_string(type)) return align(offset, 4) + 4 + idl_bound(type) + 1;
  if (idl_is_struct(type)) return end_of_struct(type, offset);
  offset = align(offset, 4) + 4;  // a sequence: its count comes first
  for (size_t k = 0; k < idl_bound(type) && offset <= SIZE_LIMIT; ++k) offset = end_of(idl_type_spec(type), offset);
  return offset;
}

static size_t end_of_member(const idl_member_t* member, size_t offset) {
  const idl_declarator_t* declarator;
  IDL_FOREACH(declarator, member->declarators) {
    const size_t count = element_count(declarator);
    for (size_t k = 0; k < count && offset <= SIZE_LIMIT; ++k) offset = end_of(member->type_spec, offset);
  }
  return offset;
}

static size_t end_of_struct(const idl_struct_t* node, size_t offset) {
  const idl_member_t* member;
  IDL_FOREACH(member, node->members) offset = end_of_member(member, offset);
  return offset;
}

size_t element_count(const idl_declarator_t* declarator) {
  return idl_is_array(declarator) ? idl_array_size(declarator) : 1;
}

size_t serialized_size_max(const idl_struct_t* node) { return align(4 + end_of_struct(node, 0), 4); }

size_t key_size(const idl_struct_t* node) { return key_size_up_to(node, NULL); }

size_t key_size_up_to(const idl_struct_t* node, const idl_member_t* last) {
  const idl_member_t* member;
  size_t offset = 0;
  IDL_FOREACH(member, node->members) {
    if (member->key.value) offset = end_of_member(member, offset);
    if (member == last) break;
  }
  return offset;
}

bool has_key(const idl_struct_t* node) { return key_size(node) > 0; }
