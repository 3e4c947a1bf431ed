/* Times functions against each other, in turns: CasADi's and ours. */
#include <stdint.h>
#include <time.h>

typedef int (*casadi_function)(const double **, double **, int64_t *, double *, int);
/* A function that returns an array by value, as x86-64 calls it: the caller gives the place. */
typedef void (*our_function)(double *, const double *, const double *, const double *);

/* All inputs at once: columns with a number for each input. */
typedef void (*our_batch)(double *, const double *, int64_t);

enum { CASADI, OURS, OUR_BATCH };
enum { MAX_JOINTS = 64 };

struct variant {
    void *function;
    int64_t kind;
    /* Numbers of a result; not 0 in a chain, where each call waits for the last one's result. */
    int64_t chained;
    double *outputs[1];
    int64_t *integers;
    double *work;
};

static double now_ns(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void run(const struct variant *variant, const double *arguments, const double *columns,
                int inputs, int n) {
    if (variant->kind == OUR_BATCH) {
        ((our_batch)variant->function)(variant->outputs[0], columns, inputs);
        return;
    }
    double waiting[3 * MAX_JOINTS];
    for (int input = 0; input < inputs; ++input) {
        const double *first = arguments + 3 * n * input;
        if (variant->chained) {
            const double *last = variant->outputs[0];
            double nothing = 0.0 * (last[0] + last[variant->chained - 1]);
            for (int k = 0; k < 3 * n; ++k) waiting[k] = first[k] + nothing;
            first = waiting;
        }
        if (variant->kind == OURS) {
            ((our_function)variant->function)(variant->outputs[0], first, first + n, first + 2 * n);
        } else {
            const double *given[3] = {first, first + n, first + 2 * n};
            double *outputs[1] = {variant->outputs[0]};
            ((casadi_function)variant->function)(given, outputs, variant->integers, variant->work, 0);
        }
    }
}

/* Calls a variant on inputs of three vectors of n numbers, given in both ways. */
void evaluate(const struct variant *variant, const double *arguments, const double *columns,
              int inputs, int n) {
    run(variant, arguments, columns, inputs, n);
}

/* Nanoseconds of one call of each variant in each round, into results[round * count + variant].
 * A round times each variant, another one first in each round: the best of five runs over all
 * inputs, `repeats` times. `arguments` holds the inputs one after the other, `columns` the
 * same numbers as columns of a matrix with a row for each input. */
void race(const struct variant *variants, int count, int rounds, int repeats,
          const double *arguments, const double *columns, int inputs, int n,
          double *results) {
    for (int round = 0; round < rounds; ++round) {
        for (int turn = 0; turn < count; ++turn) {
            int which = (turn + round) % count;
            double best = 1e300;
            for (int part = 0; part < 5; ++part) {
                double start = now_ns();
                for (int repeat = 0; repeat < repeats; ++repeat)
                    run(variants + which, arguments, columns, inputs, n);
                double time = (now_ns() - start) / ((double)repeats * inputs);
                if (time < best) best = time;
            }
            results[round * count + which] = best;
        }
    }
}
