// Includes the whole library: entities, components in columns, and batch verbs. README.md has a
// tour. Depends on the standard library and, for its memory, on mmap.
#pragma once

#include "ecs/accessor.hpp"
#include "ecs/change_reader.hpp"
#include "ecs/children.hpp"
#include "ecs/commands.hpp"
#include "ecs/component.hpp"
#include "ecs/entity.hpp"
#include "ecs/event_queue.hpp"
#include "ecs/fields.hpp"
#include "ecs/query.hpp"
#include "ecs/schedule.hpp"
#include "ecs/snapshot.hpp"
#include "ecs/system_order.hpp"
#include "ecs/system_query.hpp"
#include "ecs/world.hpp"
