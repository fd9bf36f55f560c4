// Indices of bodies and geoms in SceneContent, kept in ODE's user data.
#pragma once

#include <ode/ode.h>

#include <cstdint>

namespace cleave {

// Shifted by one, so that geometry nobody entered shows as -1.
inline void* to_data(int index) { return reinterpret_cast<void*>(static_cast<std::intptr_t>(index) + 1); }
inline int to_index(void* data) { return static_cast<int>(reinterpret_cast<std::intptr_t>(data) - 1); }

inline int index_of(dGeomID geom) { return to_index(dGeomGetData(geom)); }
inline int index_of(dBodyID body) { return body == nullptr ? -1 : to_index(dBodyGetData(body)); }

}  // namespace cleave
