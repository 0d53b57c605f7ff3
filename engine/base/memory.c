#include "base/memory.h"

#include <stdatomic.h>
#include <stdlib.h>

// The allocator is the one piece of state that a process shares.
static struct {
    atomic_size_t bytes;
    atomic_size_t peak;
    atomic_size_t budget;
    atomic_llong refuse_after; // allocations left before all are refused; negative: never
    atomic_ullong serial;      // of the last object made; never shows in a result
} vn_memory = {.refuse_after = -1};

static bool refused_for_a_test(void) {
    long long left = atomic_load_explicit(&vn_memory.refuse_after, memory_order_relaxed);
    if (left < 0) {
        return false;
    }
    if (left == 0) {
        return true;
    }
    atomic_store_explicit(&vn_memory.refuse_after, left - 1, memory_order_relaxed);
    return false;
}

static void raise_peak(size_t bytes) {
    size_t peak = atomic_load_explicit(&vn_memory.peak, memory_order_relaxed);
    while (bytes > peak && !atomic_compare_exchange_weak(&vn_memory.peak, &peak, bytes)) {
    }
}

static bool take(size_t more) {
    size_t budget = atomic_load_explicit(&vn_memory.budget, memory_order_relaxed);
    size_t bytes = atomic_fetch_add(&vn_memory.bytes, more) + more;
    if (refused_for_a_test() || (budget > 0 && bytes > budget)) {
        atomic_fetch_sub(&vn_memory.bytes, more);
        return false;
    }
    raise_peak(bytes);
    return true;
}

void *vn_resize(void *block, size_t old_size, size_t new_size) {
    if (new_size == 0) {
        free(block);
        atomic_fetch_sub(&vn_memory.bytes, old_size);
        return NULL;
    }
    size_t more = new_size > old_size ? new_size - old_size : 0;
    if (more > 0 && !take(more)) {
        return NULL;
    }
    void *grown = realloc(block, new_size);
    if (grown == NULL && more == 0) {
        grown = block; // a shrink that the C library refused: the old block is large enough
    }
    size_t given_back = grown == NULL ? more : (old_size > new_size ? old_size - new_size : 0);
    atomic_fetch_sub(&vn_memory.bytes, given_back);
    return grown;
}

size_t vn_byte_count(void) {
    return atomic_load(&vn_memory.bytes);
}

size_t vn_byte_peak(void) {
    return atomic_load(&vn_memory.peak);
}

void vn_byte_peak_reset(void) {
    atomic_store(&vn_memory.peak, atomic_load(&vn_memory.bytes));
}

void vn_set_memory_budget(size_t bytes) {
    atomic_store(&vn_memory.budget, bytes);
}

void vn_fail_allocations_from(int64_t nth) {
    atomic_store(&vn_memory.refuse_after, nth);
}

void *vn_new_block(size_t size) {
    void *block = vn_resize(NULL, 0, size);
    if (block != NULL) {
        memset(block, 0, size);
    }
    return block;
}

// The size stands before the block.
typedef union block_head {
    size_t size;
    max_align_t aligned;
} block_head;

void *vn_sized_block(size_t size) {
    if (size > SIZE_MAX - sizeof(block_head)) {
        return NULL;
    }
    block_head *head = vn_resize(NULL, 0, size + sizeof *head);
    if (head == NULL) {
        return NULL;
    }
    head->size = size + sizeof *head;
    return head + 1;
}

void vn_free_sized(void *block) {
    if (block != NULL) {
        block_head *head = (block_head *)block - 1;
        vn_resize(head, head->size, 0);
    }
}

uint64_t vn_next_serial(void) {
    return atomic_fetch_add(&vn_memory.serial, 1) + 1;
}

char *vn_copy_text(const char *text) {
    size_t size = strlen(text) + 1;
    char *copy = vn_resize(NULL, 0, size);
    return copy == NULL ? NULL : memcpy(copy, text, size);
}

void vn_free_text(char *text) {
    if (text != NULL) {
        vn_resize(text, strlen(text) + 1, 0);
    }
}
