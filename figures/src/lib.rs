//! Draws the six figures of the report, and scenes of your own.
