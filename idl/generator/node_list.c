// A growing list of syntax tree nodes. Without memory the generator ends: a build tool has nothing better
// to do then.
#include <stdlib.h>

#include "idl/generator/generator.h"

void append_node(node_list_t* list, const void* node) {
  const idl_node_t** nodes = realloc(list->nodes, (list->size + 1) * sizeof *nodes);
  if (!nodes) {
    fputs("idl/generator: out of memory\n", stderr);
    exit(EXIT_FAILURE);
  }
  list->nodes = nodes;
  list->nodes[list->size++] = node;
}

bool contains_node(const node_list_t* list, const void* node) {
  for (size_t k = 0; k < list->size; ++k) {
    if (list->nodes[k] == node) return true;
  }
  return false;
}

void free_nodes(node_list_t* list) {
  free(list->nodes);
  list->nodes = NULL;
  list->size = 0;
}
