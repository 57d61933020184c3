"""A shorter first start: what numba's front end makes of our code is shipped with it.

numba compiles in two halves. Its front end, in Python, turns functions into LLVM's bitcode; LLVM
then optimises that for the processor. The first half takes three fifths of the time and gives the
same on every machine of a kind, so it can be done before: `capture` does, `shipped` keeps the
result, and at the first start `start` has `replay` do the second half.
"""
