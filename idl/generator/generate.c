// Entry point of the back end: idlc parses, then calls `generate`. A header is written only if its
// content changes, so that an edited comment in one IDL file does not rebuild the world.
#include <idl/file.h>
#include <idlc/generator.h>
#include <stdlib.h>
#include <string.h>

#include "idl/generator/generator.h"

static bool holds(const char* path, const char* text, size_t size) {
  FILE* file = fopen(path, "rb");
  char* content = malloc(size + 1);
  const bool same = file && content && fread(content, 1, size + 1, file) == size && memcmp(content, text, size) == 0;
  free(content);
  if (file) fclose(file);
  return same;
}

static idl_retcode_t write_if_changed(const char* path, const char* text, size_t size) {
  if (holds(path, text, size)) return IDL_RETCODE_OK;
  FILE* file = fopen(path, "wb");
  bool written = file && fwrite(text, 1, size, file) == size;
  if (file && fclose(file) != 0) written = false;
  if (written) return IDL_RETCODE_OK;
  fprintf(stderr, "%s: cannot be written; its directory must exist and be writable\n", path);
  if (file) remove(path);
  return IDL_RETCODE_NO_ACCESS;
}

IDL_EXPORT int generate(const idl_pstate_t* pstate, const idlc_generator_config_t* config);

IDL_EXPORT int generate(const idl_pstate_t* pstate, const idlc_generator_config_t* config) {
  if (check_contract(pstate) > 0) return IDL_RETCODE_SEMANTIC_ERROR;
  char* path = NULL;
  idl_retcode_t result =
      idl_generate_out_file(pstate->sources->path->name, config->output_dir, config->base_dir, "hpp", &path, false);
  if (result != IDL_RETCODE_OK) return result;
  char* text = NULL;
  size_t size = 0;
  FILE* out = open_memstream(&text, &size);
  if (out) print_header(out, pstate);
  result = out && fclose(out) == 0 ? write_if_changed(path, text, size) : IDL_RETCODE_NO_MEMORY;
  free(text);
  free(path);
  return result;
}
