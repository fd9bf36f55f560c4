// Rows of Gauss-Seidel sweeps as slab_sweeps.h goes through them: eight groups of rows side by side in the
// lanes of a vector, in single precision.
#pragma once

namespace cleave {

inline constexpr int kOctetLanes = 8;

// The k-th row of each of eight groups; lambda_r - w_r / d_r = kept lambda_r + rest - (J_r / d_r) v.
// Nothing moves in the lane of a group that has no k-th row.
struct alignas(64) OctetRow {
  float jacobian[12][kOctetLanes] = {};       // J_r / d_r, six numbers of body a and six of b
  float mass_jacobian[12][kOctetLanes] = {};  // M^-1 J_r^T
  float kept[kOctetLanes] = {}, rest[kOctetLanes] = {};
  float lower[kOctetLanes] = {}, upper[kOctetLanes] = {};
  float impulse[kOctetLanes] = {};
  float change[kOctetLanes] = {};  // lambda_k - lambda_k-1 (sweep_momentum.h)
};

// Up to eight groups of rows, no two of them on one body that moves.
struct Octet {
  int first_row, row_count;
  int body_a[kOctetLanes], body_b[kOctetLanes];  // for what does not move, a body that stands still
};

// In a cache line of its own: its neighbours may be those of another thread.
struct alignas(64) SlabBody {
  float velocity[kOctetLanes] = {};  // and two zeros
  float end[kOctetLanes] = {};       // the velocity at the end of the last sweep
};

// To where a sweep begins; share: beta (sweep_momentum.h).
void push_body(float share, SlabBody& body);

// Visits every row of these groups once, in their order, from where its impulse begins. Adds (lambda_k+1 -
// y_k) d_k+1 of its rows to agreement, lane by lane.
void visit_octet(const Octet& octet, float share, OctetRow* rows, SlabBody* bodies,
                 float (&agreement)[kOctetLanes]);

}  // namespace cleave
