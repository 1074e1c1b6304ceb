// Reprints one struct from the syntax tree as IDL that stands alone: what it needs comes first. Tools
// that meet the type on the wire or in a recording need no other file to read it.
#include "idl/generator/generator.h"

// Depth first, so that each definition follows what it uses.
static void collect(node_list_t* definitions, const idl_type_spec_t* type) {
  if (idl_is_sequence(type)) type = idl_type_spec(type);
  if (!(idl_is_struct(type) || idl_is_enum(type)) || contains_node(definitions, type)) return;
  if (idl_is_struct(type)) {
    const idl_member_t* member;
    IDL_FOREACH(member, ((const idl_struct_t*)type)->members) collect(definitions, member->type_spec);
  }
  append_node(definitions, type);
}

static void print_type(FILE* out, const idl_type_spec_t* type, const void* from) {
  const primitive_t* primitive = find_primitive(type);
  if (primitive) {
    fputs(primitive->idl, out);
  } else if (idl_is_string(type)) {
    fprintf(out, "string<%u>", idl_bound(type));
  } else if (idl_is_sequence(type)) {
    fputs("sequence<", out);
    print_type(out, idl_type_spec(type), from);
    fprintf(out, ", %u>", idl_bound(type));
  } else {
    fputs(reference_name(type, from, "").text, out);
  }
}

static void print_struct(FILE* out, const idl_struct_t* node) {
  const idl_member_t* member;
  const idl_declarator_t* declarator;
  fprintf(out, "  %s@final struct %s {\n", node->nested.value ? "@nested " : "", idl_identifier(node));
  IDL_FOREACH(member, node->members) {
    IDL_FOREACH(declarator, member->declarators) {
      fputs(member->key.value ? "    @key " : "    ", out);
      print_type(out, member->type_spec, node);
      fprintf(out, " %s", idl_identifier(declarator));
      if (idl_is_array(declarator)) fprintf(out, "[%u]", idl_array_size(declarator));
      fputs(";\n", out);
    }
  }
  fputs("  };\n", out);
}

static void print_enum(FILE* out, const idl_enum_t* node) {
  const idl_enumerator_t* enumerator;
  fprintf(out, "  enum %s {", idl_identifier(node));
  IDL_FOREACH(enumerator, node->enumerators) {
    fprintf(out, "%s\n    %s", enumerator == node->enumerators ? "" : ",", idl_identifier(enumerator));
  }
  fputs("\n  };\n", out);
}

static void open_modules(FILE* out, const void* definition) {
  const void* module = idl_parent(definition);
  if (!module || !idl_is_module(module)) return;
  open_modules(out, module);
  fprintf(out, "module %s {\n", idl_identifier(module));
}

static void close_modules(FILE* out, const void* definition) {
  const void* module = idl_parent(definition);
  for (; module && idl_is_module(module); module = idl_parent(module)) fputs("};\n", out);
}

void print_idl_text(FILE* out, const idl_struct_t* node) {
  node_list_t definitions = {NULL, 0};
  collect(&definitions, node);
  for (size_t k = 0; k < definitions.size; ++k) {
    const idl_node_t* current = definitions.nodes[k];
    if (k == 0 || !in_same_module(current, definitions.nodes[k - 1])) open_modules(out, current);
    if (idl_is_struct(current)) print_struct(out, (const idl_struct_t*)current);
    if (idl_is_enum(current)) print_enum(out, (const idl_enum_t*)current);
    if (k + 1 == definitions.size || !in_same_module(current, definitions.nodes[k + 1])) close_modules(out, current);
  }
  free_nodes(&definitions);
}
