// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/format.h>

namespace pimg {

std::string format_packed(fmt::string_view pattern, fmt::format_args arguments)
{
    return fmt::vformat(pattern, arguments);
}

}  // namespace pimg
