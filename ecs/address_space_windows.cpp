#include "ecs/address_space.hpp"

#include <windows.h>

#include <cstdint>

namespace psygen::ecs::detail {

std::size_t address_space_left() {
  return SIZE_MAX;
}

void* reserve_address_space(std::size_t bytes) {
  return VirtualAlloc(nullptr, bytes, MEM_RESERVE, PAGE_NOACCESS);
}

bool commit_pages(void* first, std::size_t bytes) {
  return VirtualAlloc(first, bytes, MEM_COMMIT, PAGE_READWRITE) != nullptr;
}

void release_address_space(void* first, std::size_t) {
  VirtualFree(first, 0, MEM_RELEASE);
}

}  // namespace psygen::ecs::detail
