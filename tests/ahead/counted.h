/* Number of calls of malloc, free and the like, so far. */
long allocations(void);
