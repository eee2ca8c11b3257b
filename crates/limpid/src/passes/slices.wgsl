// The column of slices behind the front surface, each r deep, a bit each.

const WORDS: u32 = 4u;
const SLICES: i32 = 128;
