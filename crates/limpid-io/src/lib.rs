//! Readers for particle files and frame sequences.
