// Names of modules, types and enumerators, as IDL and as C++ write them. Names too long for `name_t` are
// cut off here and refused by the contract.
#include <ctype.h>
#include <string.h>

#include "idl/generator/generator.h"

static void append(name_t* name, const char* text) {
  const size_t used = strlen(name->text);
  snprintf(name->text + used, sizeof name->text - used, "%s", text);
}

name_t module_path(const void* node) {
  name_t path = {""};
  const void* parent = idl_parent(node);
  if (!parent || !idl_is_module(parent)) return path;
  path = module_path(parent);
  if (path.text[0]) append(&path, "::");
  append(&path, idl_identifier(parent));
  return path;
}

name_t qualified_name(const void* node) {
  name_t name = module_path(node);
  if (name.text[0]) append(&name, "::");
  append(&name, idl_identifier(node));
  return name;
}

bool in_same_module(const void* a, const void* b) { return strcmp(module_path(a).text, module_path(b).text) == 0; }

name_t reference_name(const void* type, const void* from, const char* root) {
  name_t name = {""};
  if (in_same_module(type, from)) {
    append(&name, idl_identifier(type));
  } else {
    append(&name, root);
    append(&name, qualified_name(type).text);
  }
  return name;
}

// A word begins at an upper-case letter after a lower-case one or a digit, and at the last upper-case
// letter of several: ImuMode and IMUMode both give IMU_MODE_.
static bool begins_word(const char* name, size_t k) {
  if (k == 0 || !isupper((unsigned char)name[k])) return false;
  return islower((unsigned char)name[k - 1]) || isdigit((unsigned char)name[k - 1]) ||
         (isupper((unsigned char)name[k - 1]) && islower((unsigned char)name[k + 1]));
}

name_t enumerator_prefix(const idl_enum_t* node) {
  name_t prefix = {""};
  const char* name = idl_identifier(node);
  for (size_t k = 0; name[k]; ++k) {
    const char upper[2] = {(char)toupper((unsigned char)name[k]), '\0'};
    if (begins_word(name, k)) append(&prefix, "_");
    append(&prefix, upper);
  }
  append(&prefix, "_");
  return prefix;
}

name_t enumerator_name(const idl_enum_t* node, const idl_enumerator_t* enumerator) {
  name_t name = {""};
  const name_t prefix = enumerator_prefix(node);
  const size_t length = strlen(prefix.text);
  const char* identifier = idl_identifier(enumerator);
  if (strncmp(identifier, prefix.text, length) != 0) return name;
  append(&name, identifier + length);
  for (char* c = name.text; *c; ++c) *c = (char)tolower((unsigned char)*c);
  return name;
}

bool is_cpp_keyword(const char* word) {
  static const char* const keywords[] = {"alignas",
                                         "alignof",
                                         "and",
                                         "and_eq",
                                         "asm",
                                         "auto",
                                         "bitand",
                                         "bitor",
                                         "bool",
                                         "break",
                                         "case",
                                         "catch",
                                         "char",
                                         "char8_t",
                                         "char16_t",
                                         "char32_t",
                                         "class",
                                         "co_await",
                                         "co_return",
                                         "co_yield",
                                         "compl",
                                         "concept",
                                         "const",
                                         "consteval",
                                         "constexpr",
                                         "constinit",
                                         "const_cast",
                                         "continue",
                                         "decltype",
                                         "default",
                                         "delete",
                                         "do",
                                         "double",
                                         "dynamic_cast",
                                         "else",
                                         "enum",
                                         "explicit",
                                         "export",
                                         "extern",
                                         "false",
                                         "float",
                                         "for",
                                         "friend",
                                         "goto",
                                         "if",
                                         "inline",
                                         "int",
                                         "long",
                                         "mutable",
                                         "namespace",
                                         "new",
                                         "noexcept",
                                         "not",
                                         "not_eq",
                                         "nullptr",
                                         "operator",
                                         "or",
                                         "or_eq",
                                         "private",
                                         "protected",
                                         "public",
                                         "register",
                                         "requires",
                                         "return",
                                         "short",
                                         "signed",
                                         "reinterpret_cast",
                                         "sizeof",
                                         "static",
                                         "static_assert",
                                         "struct",
                                         "switch",
                                         "template",
                                         "static_cast",
                                         "this",
                                         "thread_local",
                                         "throw",
                                         "true",
                                         "try",
                                         "typedef",
                                         "typeid",
                                         "typename",
                                         "union",
                                         "unsigned",
                                         "using",
                                         "virtual",
                                         "void",
                                         "volatile",
                                         "wchar_t",
                                         "while",
                                         "xor",
                                         "xor_eq"};
  for (size_t k = 0; k < sizeof keywords / sizeof *keywords; ++k) {
    if (strcmp(word, keywords[k]) == 0) return true;
  }
  return false;
}
