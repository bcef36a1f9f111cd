#ifndef DIGEST_H
#define DIGEST_H

#include <stdint.h>

// FNV-1a over 64-bit words.
#define OFFSET UINT64_C(0xcbf29ce484222325)

static inline void add(uint64_t *digest, uint64_t word)
{
    *digest = (*digest ^ word) * UINT64_C(0x100000001b3);
}

static inline void add_floats(uint64_t *digest, const void *floats, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        __builtin_memcpy(&bits, (const float *)floats + i, sizeof bits);
        add(digest, bits);
    }
}

#endif
