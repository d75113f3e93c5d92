// SPDX-License-Identifier: BSD-3-Clause
// Our declarations of OpenFX beside the official ones: every text, number, offset and signature. This file is compiled when
// PIMG_OFX_INCLUDE names the official headers, and has nothing to run.
#include <cstddef>
#include <type_traits>

namespace ours {
#include "ofx_abi_types.h"
}  // namespace ours

#include "ofx_abi.h"

namespace {

constexpr bool same_text(const char* a, const char* b)
{
    while (*a != '\0' && *a == *b)
        ++a, ++b;
    return *a == *b;
}

#define PIMG_OFX_SAME_TEXT(name, value) static_assert(same_text(name, value), #value);
#define PIMG_OFX_SAME_NUMBER(name, value) static_assert((name) == (value), #value);
PIMG_OFX_TEXTS(PIMG_OFX_SAME_TEXT)
PIMG_OFX_NUMBERS(PIMG_OFX_SAME_NUMBER)

/// The official type for one of ours: our structures and handles replaced, in the parameters of functions, too.
template<class T>
struct Official {
    using Type = T;
};
template<class T>
struct Official<T*> {
    using Type = typename Official<T>::Type*;
};
template<class T>
struct Official<const T> {
    using Type = const typename Official<T>::Type;
};
template<class Result, class... Arguments>
struct Official<Result(Arguments...)> {
    using Type = typename Official<Result>::Type(typename Official<Arguments>::Type...);
};
template<class Result, class... Arguments>
struct Official<Result(Arguments..., ...)> {
    using Type = typename Official<Result>::Type(typename Official<Arguments>::Type..., ...);
};

#define PIMG_OFX_SAME_NAME(name)                                                                                       \
    template<>                                                                                                         \
    struct Official<ours::name> {                                                                                      \
        using Type = ::name;                                                                                           \
    };
PIMG_OFX_SAME_NAME(OfxPropertySetStruct)
PIMG_OFX_SAME_NAME(OfxImageEffectStruct)
PIMG_OFX_SAME_NAME(OfxImageClipStruct)
PIMG_OFX_SAME_NAME(OfxImageMemoryStruct)
PIMG_OFX_SAME_NAME(OfxParamStruct)
PIMG_OFX_SAME_NAME(OfxParamSetStruct)
PIMG_OFX_SAME_NAME(OfxMutex)
PIMG_OFX_SAME_NAME(OfxRangeD)
PIMG_OFX_SAME_NAME(OfxPointD)
PIMG_OFX_SAME_NAME(OfxRectI)
PIMG_OFX_SAME_NAME(OfxRectD)
PIMG_OFX_SAME_NAME(OfxHost)

#define PIMG_OFX_SAME_SIZE(type) static_assert(sizeof(ours::type) == sizeof(::type), #type);
#define PIMG_OFX_SAME_MEMBER(type, member)                                                                             \
    static_assert(offsetof(ours::type, member) == offsetof(::type, member), #type "::" #member);                       \
    static_assert(std::is_same_v<Official<decltype(ours::type::member)>::Type, decltype(::type::member)>,              \
                  #type "::" #member);

PIMG_OFX_SAME_SIZE(OfxRangeD)
PIMG_OFX_SAME_MEMBER(OfxRangeD, min)
PIMG_OFX_SAME_MEMBER(OfxRangeD, max)

PIMG_OFX_SAME_SIZE(OfxPointD)
PIMG_OFX_SAME_MEMBER(OfxPointD, x)
PIMG_OFX_SAME_MEMBER(OfxPointD, y)

PIMG_OFX_SAME_SIZE(OfxRectI)
PIMG_OFX_SAME_MEMBER(OfxRectI, x1)
PIMG_OFX_SAME_MEMBER(OfxRectI, y1)
PIMG_OFX_SAME_MEMBER(OfxRectI, x2)
PIMG_OFX_SAME_MEMBER(OfxRectI, y2)

PIMG_OFX_SAME_SIZE(OfxRectD)
PIMG_OFX_SAME_MEMBER(OfxRectD, x1)
PIMG_OFX_SAME_MEMBER(OfxRectD, y1)
PIMG_OFX_SAME_MEMBER(OfxRectD, x2)
PIMG_OFX_SAME_MEMBER(OfxRectD, y2)

PIMG_OFX_SAME_SIZE(OfxHost)
PIMG_OFX_SAME_MEMBER(OfxHost, host)
PIMG_OFX_SAME_MEMBER(OfxHost, fetchSuite)

PIMG_OFX_SAME_SIZE(OfxPlugin)
PIMG_OFX_SAME_MEMBER(OfxPlugin, pluginApi)
PIMG_OFX_SAME_MEMBER(OfxPlugin, apiVersion)
PIMG_OFX_SAME_MEMBER(OfxPlugin, pluginIdentifier)
PIMG_OFX_SAME_MEMBER(OfxPlugin, pluginVersionMajor)
PIMG_OFX_SAME_MEMBER(OfxPlugin, pluginVersionMinor)
PIMG_OFX_SAME_MEMBER(OfxPlugin, setHost)
PIMG_OFX_SAME_MEMBER(OfxPlugin, mainEntry)

PIMG_OFX_SAME_SIZE(OfxPropertySuiteV1)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetPointer)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetString)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetDouble)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetInt)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetPointerN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetStringN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetDoubleN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propSetIntN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetPointer)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetString)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetDouble)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetInt)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetPointerN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetStringN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetDoubleN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetIntN)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propReset)
PIMG_OFX_SAME_MEMBER(OfxPropertySuiteV1, propGetDimension)

PIMG_OFX_SAME_SIZE(OfxImageEffectSuiteV1)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, getPropertySet)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, getParamSet)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, clipDefine)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, clipGetHandle)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, clipGetPropertySet)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, clipGetImage)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, clipReleaseImage)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, clipGetRegionOfDefinition)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, abort)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, imageMemoryAlloc)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, imageMemoryFree)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, imageMemoryLock)
PIMG_OFX_SAME_MEMBER(OfxImageEffectSuiteV1, imageMemoryUnlock)

PIMG_OFX_SAME_SIZE(OfxParameterSuiteV1)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramDefine)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetHandle)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramSetGetPropertySet)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetPropertySet)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetValue)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetValueAtTime)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetDerivative)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetIntegral)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramSetValue)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramSetValueAtTime)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetNumKeys)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetKeyTime)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramGetKeyIndex)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramDeleteKey)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramDeleteAllKeys)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramCopy)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramEditBegin)
PIMG_OFX_SAME_MEMBER(OfxParameterSuiteV1, paramEditEnd)

PIMG_OFX_SAME_SIZE(OfxMemorySuiteV1)
PIMG_OFX_SAME_MEMBER(OfxMemorySuiteV1, memoryAlloc)
PIMG_OFX_SAME_MEMBER(OfxMemorySuiteV1, memoryFree)

PIMG_OFX_SAME_SIZE(OfxMultiThreadSuiteV1)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, multiThread)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, multiThreadNumCPUs)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, multiThreadIndex)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, multiThreadIsSpawnedThread)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, mutexCreate)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, mutexDestroy)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, mutexLock)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, mutexUnLock)
PIMG_OFX_SAME_MEMBER(OfxMultiThreadSuiteV1, mutexTryLock)

PIMG_OFX_SAME_SIZE(OfxMessageSuiteV1)
PIMG_OFX_SAME_MEMBER(OfxMessageSuiteV1, message)

PIMG_OFX_SAME_SIZE(OfxMessageSuiteV2)
PIMG_OFX_SAME_MEMBER(OfxMessageSuiteV2, message)
PIMG_OFX_SAME_MEMBER(OfxMessageSuiteV2, setPersistentMessage)
PIMG_OFX_SAME_MEMBER(OfxMessageSuiteV2, clearPersistentMessage)

PIMG_OFX_SAME_SIZE(OfxProgressSuiteV1)
PIMG_OFX_SAME_MEMBER(OfxProgressSuiteV1, progressStart)
PIMG_OFX_SAME_MEMBER(OfxProgressSuiteV1, progressUpdate)
PIMG_OFX_SAME_MEMBER(OfxProgressSuiteV1, progressEnd)

PIMG_OFX_SAME_SIZE(OfxProgressSuiteV2)
PIMG_OFX_SAME_MEMBER(OfxProgressSuiteV2, progressStart)
PIMG_OFX_SAME_MEMBER(OfxProgressSuiteV2, progressUpdate)
PIMG_OFX_SAME_MEMBER(OfxProgressSuiteV2, progressEnd)

PIMG_OFX_SAME_SIZE(OfxTimeLineSuiteV1)
PIMG_OFX_SAME_MEMBER(OfxTimeLineSuiteV1, getTime)
PIMG_OFX_SAME_MEMBER(OfxTimeLineSuiteV1, gotoTime)
PIMG_OFX_SAME_MEMBER(OfxTimeLineSuiteV1, getTimeBounds)

static_assert(std::is_same_v<Official<ours::OfxStatus>::Type, ::OfxStatus>);
static_assert(std::is_same_v<Official<ours::OfxTime>::Type, ::OfxTime>);
static_assert(std::is_same_v<Official<ours::OfxPluginEntryPoint>::Type, ::OfxPluginEntryPoint>);
static_assert(std::is_same_v<Official<ours::OfxThreadFunctionV1>::Type, ::OfxThreadFunctionV1>);

}  // namespace
