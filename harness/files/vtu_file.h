// A recorded problem as a picture that ParaView and VTK read: an unstructured grid (VTK XML, .vtu) in text.
//
// Its cells are the polygons of all bodies and static geometry, then one vertex a contact, where it acts.
// Every cell has
//
//     body                     index of the body; of a contact its first one; -1: static
//     contact_row              index of the contact's normal row; -1: a polygon
//     group                    of the body, where the file names groups; -1: static
//     free_velocity_m_per_s    of the body's centre, before the constraints
//     velocity_m_per_s LABEL   of every stored solution
//     impulse_Ns LABEL         the normal impulse of a contact, of every stored solution; 0 of polygons
//     part LABEL               of the body, of every stored partition; -1: static
#pragma once

#include <string>
#include <vector>

#include "harness/files/problem_file.h"

namespace cleave {

// Throws std::invalid_argument where the file has no shapes.
std::string vtu_text(const ProblemFile& file);

struct VtuAtTime {
  double time_s;
  std::string name;  // of the .vtu, beside the list
};
// A series of such files (.pvd).
std::string pvd_text(const std::vector<VtuAtTime>& files);

}  // namespace cleave
