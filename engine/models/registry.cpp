#include "engine/models/registry.hpp"
