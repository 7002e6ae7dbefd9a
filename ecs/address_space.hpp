// Address space of this process, for ReservedMemory. Any thread.
#pragma once

#include <cstddef>

namespace psygen::ecs::detail {

// The address space that the process may still take, in bytes; SIZE_MAX if it has no limit.
std::size_t address_space_left();
// Reserves addresses without memory; null if the system refuses. Asks for huge pages.
void* reserve_address_space(std::size_t bytes);
// Gives pages of a reservation memory, which reads as zero; some may have it already.
bool commit_pages(void* first, std::size_t bytes);
// Returns a whole reservation.
void release_address_space(void* first, std::size_t bytes);

}  // namespace psygen::ecs::detail
