// The one place where volk's functions are compiled. Nothing else belongs here.
#define VK_NO_PROTOTYPES
#define VOLK_IMPLEMENTATION
#include <volk.h>
