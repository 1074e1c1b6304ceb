// A back end for idlc: from the wire contract, for each struct, a function that visits the fields of the class or
// struct a vendor's own generator made of it. Both vendors' peers compile the same text, each with its own macros
// for the name of a type and the access to a field; nothing here knows the framework's generator.
#include <idl/file.h>
#include <idl/processor.h>
#include <idl/visit.h>
#include <idlc/generator.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint32_t enumerators(const idl_enum_t* node) {
  uint32_t count = 0;
  const idl_enumerator_t* enumerator;
  IDL_FOREACH(enumerator, node->enumerators)++ count;
  return count;
}

// What the C++ type of a field does not say: how long a string or sequence may be, how many enumerators there are.
static uint32_t limit(const idl_type_spec_t* type) {
  if (idl_is_enum(type)) return enumerators((const idl_enum_t*)type);
  return idl_is_bounded(type) ? idl_bound(type) : 0;
}

static idl_retcode_t on_struct(const idl_pstate_t* pstate, bool revisit, const idl_path_t* path, const void* node,
                               void* out) {
  (void)revisit;
  (void)path;
  const idl_struct_t* type = node;
  const idl_member_t* member;
  const idl_declarator_t* declarator;
  if (type->node.symbol.location.first.source->path != pstate->sources->path) return IDL_VISIT_DONT_RECURSE;
  fprintf(out, "template <class Visitor>\nvoid visit_fields(Visitor& visitor, ECITON_NATIVE_TYPE(%s)& sample) {\n",
          idl_identifier(type));
  IDL_FOREACH(member, type->members) {
    IDL_FOREACH(declarator, member->declarators) {
      fprintf(out, "  visitor(sample.ECITON_NATIVE_FIELD(%s), %uu);\n", idl_identifier(declarator),
              (unsigned)limit(member->type_spec));
    }
  }
  fputs("}\n\n", out);
  return IDL_VISIT_DONT_RECURSE;
}

IDL_EXPORT int generate(const idl_pstate_t* pstate, const idlc_generator_config_t* config);

IDL_EXPORT int generate(const idl_pstate_t* pstate, const idlc_generator_config_t* config) {
  char* path = NULL;
  idl_retcode_t result = idl_generate_out_file(pstate->sources->path->name, config->output_dir, config->base_dir,
                                               "fields.inc", &path, false);
  if (result != IDL_RETCODE_OK) return result;
  FILE* out = fopen(path, "w");
  if (out == NULL) {
    fprintf(stderr, "%s: cannot be written\n", path);
    free(path);
    return IDL_RETCODE_NO_ACCESS;
  }
  fputs("// Generated from the wire contract; see tests/native_peers/generator/fields.c.\n\n", out);
  idl_visitor_t visitor;
  memset(&visitor, 0, sizeof visitor);
  visitor.visit = IDL_STRUCT;
  visitor.accept[IDL_ACCEPT_STRUCT] = &on_struct;
  result = idl_visit(pstate, pstate->root, &visitor, out);
  fclose(out);
  free(path);
  return result;
}
