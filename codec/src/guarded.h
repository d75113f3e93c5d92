// SPDX-License-Identifier: BSD-3-Clause
// The border of the library, which no exception crosses.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Returns what body() returns. If it throws, because memory runs out or a callback of the caller throws, returns a
/// failure.
template<class Body>
Status guarded(Body&& body)
{
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return Status::failure("pimg: out of memory");
    } catch (const std::length_error&) {
        return Status::failure("pimg: out of memory");
    } catch (const std::exception& e) {
        return Status::failure(std::string("pimg: stopped by an exception: ") + e.what());
    } catch (...) {
        return Status::failure("pimg: stopped by an exception that says nothing of itself");
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
