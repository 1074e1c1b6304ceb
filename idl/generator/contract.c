// What the house refuses in the wire contract, although idlc would take it: each refusal names the place,
// the thing and what would be right. All are reported, then nothing is generated.
#include <ctype.h>
#include <stdarg.h>
#include <string.h>

#include "idl/generator/generator.h"

enum { KEY_SIZE_MAX = 16 };  // a longer key would travel as its MD5

typedef struct check {
  const idl_pstate_t* pstate;
  int refusals;
} check_t;

idl_attribute_format_printf(3, 4) static void refuse(check_t* check, const void* node, const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  idl_error(check->pstate, idl_location(node), "error: %s", text);
  ++check->refusals;
}

// `allowed` lists names, each between spaces.
static void check_annotations(check_t* check, const idl_node_t* node, const char* what, const char* allowed) {
  const idl_annotation_appl_t* annotation;
  IDL_FOREACH(annotation, node->annotations) {
    const char* name = annotation->annotation->name->identifier;
    char word[64];
    snprintf(word, sizeof word, " %s ", name);
    if (strstr(allowed, word)) continue;
    refuse(check, node, "%s: @%s is not in the wire contract, which has only @final, @nested and @key", what, name);
  }
}

static void check_name(check_t* check, const idl_node_t* node, const char* what) {
  if (!is_cpp_keyword(idl_identifier(node))) return;
  refuse(check, node, "%s: the name is a keyword of C++; choose another", what);
}

static void check_element(check_t* check, const idl_member_t* member, const idl_type_spec_t* type, const char* what) {
  if (find_primitive(type) || idl_is_enum(type)) return;
  if (idl_is_string(type)) {
    if (!idl_is_bounded(type)) refuse(check, &member->node, "%s: a string without a bound; write string<N>", what);
  } else if (idl_is_struct(type)) {
    const idl_struct_t* node = type;
    if (node == idl_parent(member)) {
      refuse(check, &member->node, "%s: a struct within itself; write indices into a sequence of it", what);
    } else if (!node->nested.value) {
      refuse(check, &member->node, "%s: %s is a topic of its own; only a @nested struct may be a member", what,
             idl_identifier(node));
    }
  } else if (idl_is_sequence(type)) {
    refuse(check, &member->node, "%s: a sequence or array of sequences; put the inner one into a @nested struct",
           what);
  } else {
    const char* kind = idl_is_base_type(type) ? "type that not both DDS vendors know" : idl_construct(type);
    refuse(check, &member->node,
           "%s: a %s; write a number, boolean, char, enum, string<N>, sequence<T, N> or @nested struct", what, kind);
  }
}

static void check_type(check_t* check, const idl_member_t* member, const idl_declarator_t* declarator,
                       const char* what) {
  const idl_type_spec_t* type = member->type_spec;
  if (idl_is_array(declarator) && idl_next(declarator->const_expr)) {
    refuse(check, &declarator->node, "%s: an array of more than one dimension; write one, row by row", what);
  }
  if (idl_is_sequence(type) && !idl_is_array(declarator)) {
    if (!idl_is_bounded(type))
      refuse(check, &member->node, "%s: a sequence without a bound; write sequence<T, N>", what);
    type = idl_type_spec(type);
  }
  check_element(check, member, type, what);
}

// A sample and its serialized key then begin alike, and one decoder reads the key of both (core/bus/codec.hpp).
static bool stands_behind_others(const idl_struct_t* owner, const idl_member_t* key) {
  const idl_member_t* member;
  IDL_FOREACH(member, owner->members) {
    if (member == key) return false;
    if (!member->key.value) return true;
  }
  return false;
}

static void check_key(check_t* check, const idl_member_t* member, const char* what) {
  const idl_struct_t* owner = idl_parent(member);
  if (!member->key.value) return;
  if (stands_behind_others(owner, member)) {
    refuse(check, &member->node, "%s: a key behind members that are none; keys come first", what);
  }
  if (owner->nested.value) {
    refuse(check, &member->node, "%s: a key in a @nested struct; keys stand in the topic itself", what);
  }
  if (!find_primitive(member->type_spec) && !idl_is_enum(member->type_spec)) {
    refuse(check, &member->node, "%s: a %s as key; use an integer or an enum (of a text: its FNV-1a hash)", what,
           idl_construct(member->type_spec));
  }
}

static bool is_stamp(const idl_member_t* member, const idl_declarator_t* declarator) {
  const primitive_t* primitive = find_primitive(member->type_spec);
  return primitive && strcmp(primitive->idl, "int64") == 0 && !idl_is_array(declarator) &&
         strcmp(idl_identifier(declarator), "stamp_ns") == 0;
}

static void check_members(check_t* check, const idl_struct_t* node, const char* name) {
  const idl_member_t* member;
  const idl_declarator_t* declarator;
  bool stamped = node->nested.value;
  IDL_FOREACH(member, node->members) {
    IDL_FOREACH(declarator, member->declarators) {
      char what[2 * NAME_SIZE_MAX];
      snprintf(what, sizeof what, "struct %s, member %s", name, idl_identifier(declarator));
      check_name(check, &declarator->node, what);
      check_annotations(check, &member->node, what, " key ");
      check_type(check, member, declarator, what);
      check_key(check, member, what);
      stamped = stamped || is_stamp(member, declarator);
    }
  }
  if (!stamped) refuse(check, node, "struct %s: a topic without a time; add `int64 stamp_ns;` (or @nested)", name);
}

static void check_struct(check_t* check, const idl_struct_t* node, const char* name) {
  char what[2 * NAME_SIZE_MAX];
  snprintf(what, sizeof what, "struct %s", name);
  if (node->inherit_spec) refuse(check, node, "%s: inherits; write the members of the base here", what);
  if (node->keylist) refuse(check, node, "%s: #pragma keylist; write @key before the members", what);
  if (!node->members) refuse(check, node, "%s: has no members; a message says something", what);
  if (!node->extensibility.annotation || node->extensibility.value != IDL_FINAL) {
    refuse(check, node, "%s: is not @final; both DDS vendors understand each other only with @final", what);
  }
  check_annotations(check, &node->node, what, " final nested extensibility ");
  check_members(check, node, name);
}

static void check_enum(check_t* check, const idl_enum_t* node, const char* name) {
  const idl_enumerator_t* enumerator;
  const name_t prefix = enumerator_prefix(node);
  char what[2 * NAME_SIZE_MAX];
  unsigned value = 0;
  snprintf(what, sizeof what, "enum %s", name);
  check_annotations(check, &node->node, what, " ");
  IDL_FOREACH(enumerator, node->enumerators) {
    const name_t stripped = enumerator_name(node, enumerator);
    snprintf(what, sizeof what, "enum %s, enumerator %s", name, idl_identifier(enumerator));
    if (!isalpha((unsigned char)stripped.text[0])) {
      refuse(check, enumerator, "%s: does not begin with %s and a letter", what, prefix.text);
    }
    if (enumerator->value.value != value++) {
      refuse(check, enumerator, "%s: has the value %u; values count from 0 (no @value)", what,
             enumerator->value.value);
    }
  }
}

static void refuse_definition(check_t* check, const idl_node_t* node) {
  const void* named = idl_is_typedef(node) ? ((const idl_typedef_t*)node)->declarators : (const void*)node;
  const char* instead = "an enum or structs";
  if (idl_is_typedef(node)) instead = "the type itself where it is used";
  if (idl_is_const(node)) instead = "the number itself where it is used";
  if (idl_is_forward(node)) instead = "the definition before its uses";
  refuse(check, node, "%s %s: is not in the wire contract; write %s", idl_construct(node), idl_identifier(named),
         instead);
}

static void check_definition(check_t* check, const idl_node_t* node) {
  const name_t name = qualified_name(node);
  if (!idl_is_struct(node) && !idl_is_enum(node)) {
    refuse_definition(check, node);
    return;
  }
  check_name(check, node, name.text);
  if (!idl_is_module(idl_parent(node))) refuse(check, node, "%s: stands outside of any module", name.text);
  if (strlen(name.text) == NAME_SIZE_MAX - 1) {
    refuse(check, node, "%s...: the name is too long; DDS allows %d characters", name.text, NAME_SIZE_MAX - 2);
  }
  if (idl_is_struct(node)) check_struct(check, (const idl_struct_t*)node, name.text);
  if (idl_is_enum(node)) check_enum(check, (const idl_enum_t*)node, name.text);
}

static void check_sizes(check_t* check, const idl_node_t* node) {
  const name_t name = qualified_name(node);
  const idl_member_t* member;
  if (!idl_is_struct(node)) return;
  const idl_struct_t* type = (const idl_struct_t*)node;
  if (serialized_size_max(type) > SIZE_LIMIT) {
    refuse(check, node, "struct %s: may serialize to more than %d bytes; lower the bounds", name.text, SIZE_LIMIT);
  }
  IDL_FOREACH(member, type->members) {
    if (!member->key.value || key_size_up_to(type, member) <= KEY_SIZE_MAX) continue;
    refuse(check, member, "struct %s, member %s: makes the key longer than %d bytes; key by fewer or shorter members",
           name.text, idl_identifier(member->declarators), KEY_SIZE_MAX);
    break;
  }
}

static void for_each_definition(check_t* check, const void* list, void (*visit)(check_t*, const idl_node_t*)) {
  const idl_node_t* node;
  IDL_FOREACH(node, list) {
    if (idl_is_module(node)) {
      for_each_definition(check, ((const idl_module_t*)node)->definitions, visit);
    } else {
      visit(check, node);
    }
  }
}

static void check_modules(check_t* check, const void* list) {
  const idl_node_t* node;
  IDL_FOREACH(node, list) {
    if (!idl_is_module(node)) continue;
    char what[2 * NAME_SIZE_MAX];
    snprintf(what, sizeof what, "module %s", idl_identifier(node));
    check_name(check, node, what);
    check_annotations(check, node, what, " ");
    check_modules(check, ((const idl_module_t*)node)->definitions);
  }
}

int check_contract(const idl_pstate_t* pstate) {
  check_t check = {pstate, 0};
  check_modules(&check, pstate->root);
  for_each_definition(&check, pstate->root, check_definition);
  if (check.refusals == 0)
    for_each_definition(&check, pstate->root, check_sizes);  // which only the allowed types have
  return check.refusals;
}
