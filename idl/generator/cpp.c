// Prints the C++ header of one IDL file: the types as plain structs, then what is known of them as
// specialisations of the traits in core/bus/type_traits.hpp.
#include <string.h>

#include "idl/generator/generator.h"

// C++ spells an enumerator that is a keyword there with an underscore after it; its name stays as it is.
static name_t cpp_enumerator(const idl_enum_t* node, const idl_enumerator_t* enumerator) {
  name_t name = enumerator_name(node, enumerator);
  const size_t length = strlen(name.text);
  if (is_cpp_keyword(name.text)) snprintf(name.text + length, sizeof name.text - length, "_");
  return name;
}

static const char* file_name(const char* path) {
  const char* slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static void print_type(FILE* out, const idl_type_spec_t* type, const void* from) {
  const primitive_t* primitive = find_primitive(type);
  if (primitive) {
    fputs(primitive->cpp, out);
  } else if (idl_is_string(type)) {
    fprintf(out, "::eciton::BoundedString<%u>", idl_bound(type));
  } else if (idl_is_sequence(type)) {
    fputs("::eciton::BoundedVector<", out);
    print_type(out, idl_type_spec(type), from);
    fprintf(out, ", %u>", idl_bound(type));
  } else {
    fputs(reference_name(type, from, "::").text, out);
  }
}

static void print_member(FILE* out, const idl_member_t* member, const idl_declarator_t* declarator) {
  const void* owner = idl_parent(member);
  fputs("  ", out);
  if (idl_is_array(declarator)) {
    fputs("std::array<", out);
    print_type(out, member->type_spec, owner);
    fprintf(out, ", %u>", idl_array_size(declarator));
  } else {
    print_type(out, member->type_spec, owner);
  }
  fprintf(out, " %s{};\n", idl_identifier(declarator));
}

static void print_struct(FILE* out, const idl_struct_t* node) {
  const idl_member_t* member;
  const idl_declarator_t* declarator;
  fprintf(out, "struct %s {\n", idl_identifier(node));
  IDL_FOREACH(member, node->members) {
    IDL_FOREACH(declarator, member->declarators) print_member(out, member, declarator);
  }
  fprintf(out, "  bool operator==(const %s&) const = default;\n};\n", idl_identifier(node));
}

static void print_enum(FILE* out, const idl_enum_t* node) {
  const idl_enumerator_t* enumerator;
  fprintf(out, "enum class %s : std::uint32_t {", idl_identifier(node));
  IDL_FOREACH(enumerator, node->enumerators) {
    fprintf(out, "%s %s", enumerator == node->enumerators ? "" : ",", cpp_enumerator(node, enumerator).text);
  }
  fputs(" };\n", out);
}

static void print_types(FILE* out, const node_list_t* definitions) {
  for (size_t k = 0; k < definitions->size; ++k) {
    const idl_node_t* current = definitions->nodes[k];
    const name_t module = module_path(current);
    if (k == 0 || !in_same_module(current, definitions->nodes[k - 1]))
      fprintf(out, "namespace %s {\n\n", module.text);
    if (idl_is_struct(current)) print_struct(out, (const idl_struct_t*)current);
    if (idl_is_enum(current)) print_enum(out, (const idl_enum_t*)current);
    fputs("\n", out);
    if (k + 1 == definitions->size || !in_same_module(current, definitions->nodes[k + 1])) {
      fprintf(out, "}  // namespace %s\n\n", module.text);
    }
  }
}

static void print_visit(FILE* out, const char* function, const idl_struct_t* node, bool key_only) {
  const idl_member_t* member;
  const idl_declarator_t* declarator;
  fprintf(out,
          "  template <class Visitor, class Sample>\n"
          "  static constexpr void %s([[maybe_unused]] Visitor&& visitor, [[maybe_unused]] Sample& sample) {\n",
          function);
  IDL_FOREACH(member, node->members) {
    if (key_only && !member->key.value) continue;
    IDL_FOREACH(declarator, member->declarators) {
      const char* name = idl_identifier(declarator);
      fprintf(out, "    visitor(\"%s\", sample.%s);\n", name, name);
    }
  }
  fputs("  }\n", out);
}

static void print_struct_traits(FILE* out, const idl_struct_t* node) {
  const name_t name = qualified_name(node);
  fprintf(out,
          "template <>\n"
          "struct eciton::bus::TypeTraits<::%s> {\n"
          "  static constexpr std::string_view name = \"%s\";\n"
          "  static constexpr bool keyed = %s;\n"
          "  static constexpr bool topic = %s;\n"
          "  static constexpr std::size_t size_max = %zu;\n"
          "  static constexpr std::size_t key_size = %zu;\n"
          "  static constexpr std::string_view idl = R\"idl(",
          name.text, name.text, has_key(node) ? "true" : "false", node->nested.value ? "false" : "true",
          serialized_size_max(node), key_size(node));
  print_idl_text(out, node);
  fputs(")idl\";\n", out);
  print_visit(out, "visit", node, false);
  print_visit(out, "visit_key", node, true);
  fprintf(out, "};\nstatic_assert(std::is_trivially_copyable_v<::%s>);\n\n", name.text);
}

static void print_enum_traits(FILE* out, const idl_enum_t* node) {
  const idl_enumerator_t* enumerator;
  const name_t name = qualified_name(node);
  size_t count = 0;
  IDL_FOREACH(enumerator, node->enumerators)++ count;
  fprintf(out,
          "template <>\n"
          "struct eciton::bus::EnumTraits<::%s> {\n"
          "  static constexpr std::string_view name = \"%s\";\n"
          "  static constexpr std::array<std::string_view, %zu> names{",
          name.text, name.text, count);
  IDL_FOREACH(enumerator, node->enumerators) {
    fprintf(out, "%s\"%s\"", enumerator == node->enumerators ? "" : ", ", enumerator_name(node, enumerator).text);
  }
  fputs("};\n};\n\n", out);
}

static void print_traits(FILE* out, const node_list_t* definitions) {
  for (size_t k = 0; k < definitions->size; ++k) {
    const idl_node_t* node = definitions->nodes[k];
    if (idl_is_struct(node)) print_struct_traits(out, (const idl_struct_t*)node);
    if (idl_is_enum(node)) print_enum_traits(out, (const idl_enum_t*)node);
  }
}

// Definitions of included files stand in the same tree; they have headers of their own.
static void collect_own(node_list_t* definitions, const idl_pstate_t* pstate, const void* list) {
  const idl_node_t* node;
  IDL_FOREACH(node, list) {
    if (idl_is_module(node)) {
      collect_own(definitions, pstate, ((const idl_module_t*)node)->definitions);
    } else if (node->symbol.location.first.source->path == pstate->sources->path) {
      append_node(definitions, node);
    }
  }
}

static void print_includes(FILE* out, const idl_pstate_t* pstate) {
  fputs(
      "#include <array>\n#include <cstddef>\n#include <cstdint>\n#include <string_view>\n#include <type_traits>\n\n"
      "#include \"core/base/bounded.hpp\"\n#include \"core/bus/type_traits.hpp\"\n",
      out);
  for (const idl_source_t* include = pstate->sources->includes; include; include = include->next) {
    const char* name = file_name(include->path->name);
    const char* dot = strrchr(name, '.');
    fprintf(out, "#include \"idl/%.*s.hpp\"\n", dot ? (int)(dot - name) : (int)strlen(name), name);
  }
  fputs("\n", out);
}

void print_header(FILE* out, const idl_pstate_t* pstate) {
  fprintf(out,
          "// Generated from %s by idl/generator: change that file, not this one. Types of the wire contract as\n"
          "// plain structs, and what the bus and the tools know about them.\n"
          "#pragma once\n\n",
          file_name(pstate->sources->path->name));
  print_includes(out, pstate);
  node_list_t definitions = {NULL, 0};
  collect_own(&definitions, pstate, pstate->root);
  print_types(out, &definitions);
  print_traits(out, &definitions);
  free_nodes(&definitions);
}
