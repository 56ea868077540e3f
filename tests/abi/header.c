/* The public header stands alone, may be included twice, and is C89 and C++98 but for stdint.h. */
#include <talus/talus.h>
#include <talus/talus.h>
