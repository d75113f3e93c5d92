// SPDX-License-Identifier: BSD-3-Clause
// What MemorySanitizer cannot see, as these libraries are not instrumented: that zstd reads what it is given and writes what
// it returns, and that the C++ library fills the links of a new node of a map. The programs built with MemorySanitizer
// contain this; the linker's --wrap leads the calls through it.
#include <map>

#include <sanitizer/msan_interface.h>
#include <zstd.h>

extern "C" {

std::size_t __real_ZSTD_compress(void* to, std::size_t capacity, const void* from, std::size_t size, int level);
std::size_t __real_ZSTD_decompress(void* to, std::size_t capacity, const void* from, std::size_t size);
void __real__ZSt29_Rb_tree_insert_and_rebalancebPSt18_Rb_tree_node_baseS0_RS_(bool left, std::_Rb_tree_node_base* node,
                                                                              std::_Rb_tree_node_base* parent,
                                                                              std::_Rb_tree_node_base& header);

std::size_t __wrap_ZSTD_compress(void* to, std::size_t capacity, const void* from, std::size_t size, int level)
{
    __msan_check_mem_is_initialized(from, size);
    const std::size_t written = __real_ZSTD_compress(to, capacity, from, size, level);
    if (!ZSTD_isError(written))
        __msan_unpoison(to, written);
    return written;
}

std::size_t __wrap_ZSTD_decompress(void* to, std::size_t capacity, const void* from, std::size_t size)
{
    __msan_check_mem_is_initialized(from, size);
    const std::size_t written = __real_ZSTD_decompress(to, capacity, from, size);
    if (!ZSTD_isError(written))
        __msan_unpoison(to, written);
    return written;
}

void __wrap__ZSt29_Rb_tree_insert_and_rebalancebPSt18_Rb_tree_node_baseS0_RS_(bool left, std::_Rb_tree_node_base* node,
                                                                              std::_Rb_tree_node_base* parent,
                                                                              std::_Rb_tree_node_base& header)
{
    __real__ZSt29_Rb_tree_insert_and_rebalancebPSt18_Rb_tree_node_baseS0_RS_(left, node, parent, header);
    __msan_unpoison(node, sizeof *node);
}

}  // extern "C"
