// SPDX-License-Identifier: BSD-3-Clause
// The suites that do not belong to properties, parameters or images.
#include "host.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace test_host {

namespace {

HostOptions options;

Effect* effect_of(void* handle)
{
    return handle != nullptr ? &Effect::of(static_cast<OfxImageEffectHandle>(handle)) : nullptr;
}

OfxStatus keep(void* handle, const char* type, const char* format, va_list arguments)
{
    char line[1000];
    std::vsnprintf(line, sizeof line, format, arguments);
    if (Effect* effect = effect_of(handle)) {
        const std::lock_guard<std::mutex> lock(effect->message_mutex);
        effect->message = line;
    }
    std::fprintf(stderr, "%s: %s\n", type, line);
    return kOfxStatOK;
}

OfxStatus message(void* handle, const char* type, const char*, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const OfxStatus status = keep(handle, type, format, arguments);
    va_end(arguments);
    return status;
}

OfxStatus clear_message(void* handle)
{
    if (Effect* effect = effect_of(handle)) {
        const std::lock_guard<std::mutex> lock(effect->message_mutex);
        effect->message.clear();
    }
    return kOfxStatOK;
}

OfxStatus begin_progress(void* handle, const char*)
{
    Effect* effect = effect_of(handle);
    if (effect == nullptr)
        return kOfxStatErrBadHandle;
    if (effect->progress_open.exchange(1) != 0)
        violation("a second bar of progress is opened");
    return kOfxStatOK;
}

OfxStatus begin_named_progress(void* handle, const char* label, const char*)
{
    return begin_progress(handle, label);
}

OfxStatus update_progress(void* handle, double progress)
{
    Effect* effect = effect_of(handle);
    if (effect == nullptr || effect->progress_open == 0 || !(progress >= 0.0 && progress <= 1.0)) {
        violation("progress without a bar, or not between 0 and 1");
        return kOfxStatErrBadHandle;
    }
    ++effect->progress_calls;
    return kOfxStatOK;
}

OfxStatus end_progress(void* handle)
{
    Effect* effect = effect_of(handle);
    if (effect == nullptr || effect->progress_open.exchange(0) == 0)
        violation("a bar of progress is closed that was not open");
    return kOfxStatOK;
}

thread_local bool spawned = false;
thread_local unsigned int spawned_index = 0;

OfxStatus multi_thread(OfxThreadFunctionV1 function, unsigned int count, void* argument)
{
    if (spawned)
        return kOfxStatErrExists;
    if (count == 0)
        count = options.threads;
    std::vector<std::thread> threads;
    for (unsigned int i = 0; i < count; ++i)
        threads.emplace_back([=] {
            spawned = true;
            spawned_index = i;
            function(i, count, argument);
        });
    for (std::thread& thread : threads)
        thread.join();
    return kOfxStatOK;
}

std::recursive_mutex& mutex_of(OfxMutexHandle handle)
{
    return *reinterpret_cast<std::recursive_mutex*>(handle);
}

const OfxMultiThreadSuiteV1 kThreadSuite = {
    multi_thread,
    [](unsigned int* count) -> OfxStatus {
        *count = options.threads;
        return kOfxStatOK;
    },
    [](unsigned int* index) -> OfxStatus {
        *index = spawned_index;
        return kOfxStatOK;
    },
    [] { return spawned ? 1 : 0; },
    [](OfxMutexHandle* handle, int) -> OfxStatus {
        *handle = reinterpret_cast<OfxMutexHandle>(new std::recursive_mutex);
        return kOfxStatOK;
    },
    [](OfxMutexHandle handle) -> OfxStatus {
        delete &mutex_of(handle);
        return kOfxStatOK;
    },
    [](OfxMutexHandle handle) -> OfxStatus {
        mutex_of(handle).lock();
        return kOfxStatOK;
    },
    [](OfxMutexHandle handle) -> OfxStatus {
        mutex_of(handle).unlock();
        return kOfxStatOK;
    },
    [](OfxMutexHandle handle) -> OfxStatus { return mutex_of(handle).try_lock() ? kOfxStatOK : kOfxStatFailed; },
};

const OfxMemorySuiteV1 kMemorySuite = {
    [](void*, size_t bytes, void** memory) -> OfxStatus {
        *memory = std::malloc(bytes);
        return *memory != nullptr ? kOfxStatOK : kOfxStatErrMemory;
    },
    [](void* memory) -> OfxStatus {
        std::free(memory);
        return kOfxStatOK;
    },
};

const OfxMessageSuiteV1 kMessageSuite = { message };
const OfxMessageSuiteV2 kLastingMessageSuite = { message, message, clear_message };
const OfxProgressSuiteV1 kProgressSuite = { begin_progress, update_progress, end_progress };
const OfxProgressSuiteV2 kNamedProgressSuite = { begin_named_progress, update_progress, end_progress };

}  // namespace

void set_up_suites(const HostOptions& given)
{
    options = given;
}

const void* fetch_suite(OfxPropertySetHandle, const char* name, int version)
{
    const struct {
        const char* name;
        int version;
        const void* suite;
    } all[] = {
        { kOfxPropertySuite, 1, &property_suite() },    { kOfxImageEffectSuite, 1, &effect_suite() },
        { kOfxParameterSuite, 1, &parameter_suite() },  { kOfxMultiThreadSuite, 1, &kThreadSuite },
        { kOfxMemorySuite, 1, &kMemorySuite },          { kOfxMessageSuite, 1, &kMessageSuite },
        { kOfxMessageSuite, 2, &kLastingMessageSuite }, { kOfxProgressSuite, 1, &kProgressSuite },
        { kOfxProgressSuite, 2, &kNamedProgressSuite },
    };
    if (options.without.count(name) > 0)
        return nullptr;
    for (const auto& entry : all)
        if (std::string(entry.name) == name && entry.version == version)
            return entry.suite;
    return nullptr;
}

}  // namespace test_host
