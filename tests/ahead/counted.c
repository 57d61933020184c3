/* Counts the allocations of the whole program: its own malloc and free stand before the C library's,
 * also for every shared library that it loads.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <stddef.h>

#include "counted.h"

extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t), *__libc_memalign(size_t, size_t);
extern void __libc_free(void *);

static long count;

long allocations(void) { return count; }

void *malloc(size_t size) { return count++, __libc_malloc(size); }
void *calloc(size_t number, size_t size) { return count++, __libc_calloc(number, size); }
void *realloc(void *old, size_t size) { return count++, __libc_realloc(old, size); }
void *aligned_alloc(size_t to, size_t size) { return count++, __libc_memalign(to, size); }
void *memalign(size_t to, size_t size) { return count++, __libc_memalign(to, size); }
void free(void *old) { count++, __libc_free(old); }

int posix_memalign(void **made, size_t to, size_t size) {
    count++;
    *made = __libc_memalign(to, size);
    return *made ? 0 : ENOMEM;
}
