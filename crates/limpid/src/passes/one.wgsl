// Formulas over pixels that kernels take one at a time or four (`four.wgsl`), as numbers of the one or of all.
alias Reals = f32;
alias Words = u32;
alias Bools = bool;
