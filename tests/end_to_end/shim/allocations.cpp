// Replaces SQLite's allocator, so that its nth allocation can fail; other allocations are unchanged.
#include <dlfcn.h>
#include <sqlite3.h>

#include <cstdlib>

#include "tests/end_to_end/shim/plan.h"

namespace {

using peclet::drill::Call;
using peclet::drill::strike;

sqlite3_mem_methods original;

void* allocate(int size) { return strike(Call::allocation, "") == 0 ? original.xMalloc(size) : nullptr; }

void* reallocate(void* block, int size) {
  return strike(Call::allocation, "") == 0 ? original.xRealloc(block, size) : nullptr;
}

// Runs before main(), because SQLite accepts an allocator only before its first use. Engines have no SQLite.
__attribute__((constructor)) void take_over() {
  if (std::getenv("PECLET_FAULT_BOARD") == nullptr) return;
  void* const symbol = dlsym(RTLD_DEFAULT, "sqlite3_config");
  if (symbol == nullptr) return;
  const auto configure = reinterpret_cast<int (*)(int, ...)>(symbol);
  if (configure(SQLITE_CONFIG_GETMALLOC, &original) != SQLITE_OK) std::abort();
  sqlite3_mem_methods ours = original;
  ours.xMalloc = allocate;
  ours.xRealloc = reallocate;
  if (configure(SQLITE_CONFIG_MALLOC, &ours) != SQLITE_OK) std::abort();
}

}  // namespace
