#pragma once
// The memory that a run takes, in one place: `talus validate` prints it and talusd derives its limit from it.

namespace talus {

/// Arrays of the particles, neighbour lists, copies for output. Measured peaks of the illustrative slope with 55,000
/// and 212,000 particles, wall particles counted like soil: 545 bytes each while the run steps, 1,163 once it has
/// written a checkpoint (the state in double precision, and HDF5's image of it).
inline constexpr double bytes_per_particle = 1160.0;
/// Program and libraries; the same measurement.
inline constexpr double bytes_of_program = 29e6;

/// [bytes]
constexpr double run_memory(double particles) { return bytes_of_program + bytes_per_particle * particles; }

}  // namespace talus
