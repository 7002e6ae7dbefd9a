// Compiles volk's functions, and nothing else.
#define VK_NO_PROTOTYPES
#define VOLK_IMPLEMENTATION
#include "volk_names.h"  // before volk.h
//
#include <volk.h>
