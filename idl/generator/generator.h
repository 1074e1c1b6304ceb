// A back end of Cyclone's idlc that prints plain C++20: what its parts offer each other. In C, because
// idlc's headers forward-declare enums, which C++ refuses.
#ifndef ECITON_IDL_GENERATOR_GENERATOR_H_
#define ECITON_IDL_GENERATOR_GENERATOR_H_

#include <idl/processor.h>
#include <idl/tree.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// DDS limits type names to 256 characters with their end; the contract refuses longer ones.
enum { NAME_SIZE_MAX = 256 };

typedef struct name {
  char text[NAME_SIZE_MAX];
} name_t;

// node_list.c

typedef struct node_list {
  const idl_node_t** nodes;
  size_t size;
} node_list_t;

void append_node(node_list_t* list, const void* node);
bool contains_node(const node_list_t* list, const void* node);
void free_nodes(node_list_t* list);

// names.c

/// The module a definition stands in, as "a::b".
name_t module_path(const void* node);
/// "a::b::Type".
name_t qualified_name(const void* node);
bool in_same_module(const void* a, const void* b);
/// How to write a type from within another definition: bare in the same module, else `root`a::b::Type.
name_t reference_name(const void* type, const void* from, const char* root);
/// What every enumerator of an enum begins with: "EstimatorMode" gives "ESTIMATOR_MODE_".
name_t enumerator_prefix(const idl_enum_t* node);
/// The enumerator without that prefix, in lower case; empty if it does not begin with it.
name_t enumerator_name(const idl_enum_t* node, const idl_enumerator_t* enumerator);
bool is_cpp_keyword(const char* word);

// primitives.c

typedef struct primitive {
  idl_type_t type;
  size_t size;  // in XCDR1, where it is also the alignment
  const char* cpp;
  const char* idl;
} primitive_t;

/// NULL if the type is no primitive of the contract.
const primitive_t* find_primitive(const idl_type_spec_t* type);

// layout.c

/// More than this is a slip of the pen; it also bounds the work of finding out.
enum { SIZE_LIMIT = 1 << 20 };

/// Greatest XCDR1 size with encapsulation header, a multiple of 4; beyond SIZE_LIMIT only "too large" is meant.
size_t serialized_size_max(const idl_struct_t* node);
/// Size of the key members in plain CDR, as hashed for the DDS key.
size_t key_size(const idl_struct_t* node);
/// The same with `last` and what stands before it; all with NULL.
size_t key_size_up_to(const idl_struct_t* node, const idl_member_t* last);
bool has_key(const idl_struct_t* node);
/// How many elements an array declarator has, 1 for a plain one.
size_t element_count(const idl_declarator_t* declarator);

// contract.c

/// Reports each violation of the house's rules with its place; returns how many.
int check_contract(const idl_pstate_t* pstate);

// idl_text.c

/// Prints IDL that declares one struct and all it needs, in modules.
void print_idl_text(FILE* out, const idl_struct_t* node);

// cpp.c

void print_header(FILE* out, const idl_pstate_t* pstate);

#endif  // ECITON_IDL_GENERATOR_GENERATOR_H_
