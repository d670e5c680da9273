// Look-ups of lanes in a scene. Each of the files named below doubles the readable or model header
// of its name, and is a part of this namespace. Compiled once for each instruction set: include
// after Highway's foreach_target.h.

#if defined(FENESTRA_LANE_SCENE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_LANE_SCENE_INL_H
#undef FENESTRA_LANE_SCENE_INL_H
#else
#define FENESTRA_LANE_SCENE_INL_H
#endif

#include "clip/keep/Seams.h"
#include "transport/lanes/PathTables.h"
#include "transport/lanes/TrackerTables.h"
// After foreach_target.h:
#include "base/LaneMath-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
#include "transport/lanes/Medium-inl.h"
// Parts of a look-up:
#include "transport/lanes/Clip-inl.h"
#include "transport/lanes/Shares-inl.h"
// Matter, made of these:
#include "transport/lanes/Matter-inl.h"
#include "transport/lanes/Mixture-inl.h"
// Rays among cells:
#include "transport/lanes/Way-inl.h"
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
