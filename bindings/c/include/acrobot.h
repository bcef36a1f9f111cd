// Gymnasium's Acrobot in C and C++: one or a batch, and control, in single precision.
//
// - You provide the memory, and may reuse it at any time. No function allocates, aborts or has
//   global state. Threads and interrupts may use different acrobots at the same time.
// - Unless the status is ACROBOT_OK, acrobots and results are unchanged.
// - A pointer must be null or point to what its type says. `error`, and the `observation` of a
//   reset, may be null. The functions report null, misaligned pointers and zeroed memory, but not
//   freed memory.
// - Arguments, and arrays of a struct, must not overlap. The functions report arrays that overlap,
//   and a result or error that would overwrite the acrobot, or what else an `_init` has made.
// - Arrays have `count` elements, in a batch one for each acrobot; `index` and `step` count from 0.
// - Numbers are in SI units.

#ifndef ACROBOT_H
#define ACROBOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef ACROBOT_ALIGNED
#if defined(_MSC_VER)
#define ACROBOT_ALIGNED(bytes) __declspec(align(bytes))
#else
// Also in C99: ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[…];
#define ACROBOT_ALIGNED(bytes) __attribute__((aligned(bytes)))
#endif
#endif

#if UINTPTR_MAX > 0xFFFFFFFF || defined(__wasm__)
// There are snapshots.
#define ACROBOT_HAS_SNAPSHOTS
// Bytes of an acrobot_t, and of an acrobot_action_space_t.
#define ACROBOT_SIZE 304
#define ACROBOT_ACTION_SPACE_SIZE 96
#define ACROBOT_GENERATOR 80
#else
// A microcontroller has no snapshots, and smaller acrobots.
#define ACROBOT_SIZE 240
#define ACROBOT_ACTION_SPACE_SIZE 48
#define ACROBOT_GENERATOR 40
#endif

// Define ACROBOT_INSTRUMENTS if the library is compiled with the feature `instruments`: then an
// acrobot of a batch has a motor and sensors, and needs more memory.
#ifdef ACROBOT_INSTRUMENTS
#define ACROBOT_BATCH_HEADER 896
#define ACROBOT_MEMORY 224
#else
#define ACROBOT_BATCH_HEADER 704
#define ACROBOT_MEMORY 0
#endif

// Bytes of a batch of `count` acrobots, and of one with own parameters, as constants of size_t:
// sizeof is one without a cast, of which C++ compilers may warn.
#ifdef __wasm__
#define ACROBOT_BATCH_SIZE(count) ACROBOT_BATCH_OF(count, 4, 192)
#define ACROBOT_BATCH_OWN_SIZE(count) ACROBOT_BATCH_OF(count, 4, 192 + 576)
#elif UINTPTR_MAX > 0xFFFFFFFF
#define ACROBOT_BATCH_SIZE(count) ACROBOT_BATCH_OF(count, 16, 640)
#define ACROBOT_BATCH_OWN_SIZE(count) ACROBOT_BATCH_OF(count, 16, 640 + 2240)
#else
#define ACROBOT_BATCH_SIZE(count) ACROBOT_BATCH_OF(count, 1, 64)
#define ACROBOT_BATCH_OWN_SIZE(count) ACROBOT_BATCH_OF(count, 1, 64 + 192)
#endif
#define ACROBOT_BATCH_OF(count, lanes, block) \
  (ACROBOT_BATCH_HEADER + (count) * sizeof(char[ACROBOT_GENERATOR]) + \
   ((count) + sizeof(char[lanes]) - 1) / lanes * ((block + lanes * ACROBOT_MEMORY + 63) / 64 * 64))

// cbindgen writes the rest, and its comments, from the library's source.

// Action 0: −1 N m by default.
#define ACROBOT_ACTION_NEGATIVE 0

// Action 1: no torque by default.
#define ACROBOT_ACTION_ZERO 1

// Action 2: +1 N m by default.
#define ACROBOT_ACTION_POSITIVE 2

// The equations of Sutton & Barto's book: the physical double pendulum. Gymnasium's default.
#define ACROBOT_DYNAMICS_BOOK 0

// The equations of Sutton's paper of 1996 (NIPS 8), which do not conserve energy.
#define ACROBOT_DYNAMICS_NIPS 1

// The parameter stays as it is.
#define ACROBOT_DRAW_FIXED 0

// Uniformly from `low` to `high`.
#define ACROBOT_DRAW_UNIFORM 1

// Its logarithm uniformly; `low` is above 0.
#define ACROBOT_DRAW_LOG_UNIFORM 2

// From a normal distribution truncated at `low` and `high`. `mean` is between these, and the
// standard deviation above 0.
#define ACROBOT_DRAW_NORMAL 3

// Gymnasium's `Acrobot-v1`: swing the tip above a height within 500 steps of 0.2 s.
#define ACROBOT_TASK_GYMNASIUM 0

// dm_control's `acrobot-swingup`, with friction: from rest anywhere to upright within 1,000 steps
// of 0.01 s. The reward is from 0 to 1. The observation has the sines of both links' angles from
// upright, their cosines, and the velocities.
#define ACROBOT_TASK_SWINGUP 1

// Stay upright for 500 steps of 0.02 s with a motor of 10 N m, from within ±0.05 of upright. The
// reward is 1 upright and 0 hanging.
#define ACROBOT_TASK_BALANCE 2

// Its alignment. malloc may align less, on microcontrollers to 8 bytes.
#define ACROBOT_ALIGN 16

// Bytes of an acrobot_planner_t.
#define ACROBOT_PLANNER_SIZE 752

// Bytes of an acrobot_swing_up_t.
#define ACROBOT_SWING_UP_SIZE 496

// Bytes of an acrobot_estimator_t.
#define ACROBOT_ESTIMATOR_SIZE 304

// Bytes of an acrobot_parameter_estimator_t.
#define ACROBOT_PARAMETER_ESTIMATOR_SIZE 1344

// Bytes of an acrobot_regression_t.
#define ACROBOT_REGRESSION_SIZE 992

// Bytes of an acrobot_controller_t.
#define ACROBOT_CONTROLLER_SIZE 5808

// Bytes of an acrobot_replanner_t.
#define ACROBOT_REPLANNER_SIZE 5392

// Alignment of a batch's memory.
#define ACROBOT_BATCH_ALIGN 64

// The default: the step after an episode's end resets the acrobot. It ignores the action and
// returns the initial observation and a reward of 0.
#define ACROBOT_AUTORESET_NEXT_STEP 0

// The step that ends an episode resets the acrobot. It returns the initial observation, and the
// last one in `final_observations`.
#define ACROBOT_AUTORESET_SAME_STEP 1

// The acrobots step on until acrobot_batch_reset_masked or another reset.
#define ACROBOT_AUTORESET_DISABLED 2

#if defined(ACROBOT_INSTRUMENTS)
// The longest delay, steps.
#define ACROBOT_LONGEST_DELAY 8
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// Bytes of a snapshot of an acrobot, at most.
#define ACROBOT_SNAPSHOT_SIZE 224
#endif

typedef enum {
  ACROBOT_OK = 0,
  // A pointer is null that must not be.
  ACROBOT_ERROR_NULL = 1,
  // A pointer is not aligned as its type demands; a batch needs ACROBOT_BATCH_ALIGN.
  ACROBOT_ERROR_MISALIGNED = 2,
  ACROBOT_ERROR_BUFFER_TOO_SMALL = 3,
  // No `_init` function has initialized the memory, or it has been overwritten.
  ACROBOT_ERROR_NOT_INITIALIZED = 4,
  // The batch was copied to another address.
  ACROBOT_ERROR_MOVED = 5,
  ACROBOT_ERROR_UNKNOWN_ACTION = 6,
  // A number is outside its range, infinite or NaN. An argument `error` says which.
  ACROBOT_ERROR_OUT_OF_RANGE = 7,
  // The count is 0, or not that of the batch.
  ACROBOT_ERROR_WRONG_COUNT = 8,
  ACROBOT_ERROR_NO_SUCH_INDEX = 9,
  // Two arguments overlap: arrays, or a result and the acrobot or batch.
  ACROBOT_ERROR_OVERLAP = 10,
  // A snapshot has another checksum.
  ACROBOT_ERROR_DAMAGED_SNAPSHOT = 11,
  // A snapshot is of another type, version or arithmetic, or contains what a setter rejects.
  ACROBOT_ERROR_OTHER_SNAPSHOT = 12,
  // The batch has no memory for parameters of each acrobot.
  ACROBOT_ERROR_SHARED_PARAMS = 13,
} acrobot_status_t;

// Why a call was rejected with ACROBOT_ERROR_OUT_OF_RANGE. acrobot_error_text has a text for each.
typedef enum {
  ACROBOT_OUT_OF_RANGE = 0,
  // An element of a matrix, a result, or what leads to it is not finite.
  ACROBOT_NOT_FINITE = 1,
  ACROBOT_NOT_SYMMETRIC = 2,
  ACROBOT_NOT_SEMIDEFINITE = 3,
  // `value` is the first velocity that is not 0, or acceleration that is too large.
  ACROBOT_NOT_IN_EQUILIBRIUM = 4,
  // The torque does not reach a motion that grows or persists.
  ACROBOT_NOT_STABILIZABLE = 5,
  // The weights do not see a motion that persists.
  ACROBOT_NOT_DETECTABLE = 6,
  // The error of a gain can be above 1e-9 of its largest element, or rounding breaks it.
  ACROBOT_ILL_CONDITIONED = 7,
  // So many tries find no plan.
  ACROBOT_NO_PLAN = 8,
  // The measured angles do not show a motion that grows or persists.
  ACROBOT_NOT_OBSERVABLE = 9,
  // The noise does not excite a motion that persists.
  ACROBOT_NOT_EXCITED = 10,
} acrobot_error_kind_t;

// Acrobots in the memory of acrobot_batch_init. It contains pointers into this memory, so do not
// move or copy it.
typedef struct acrobot_batch_t acrobot_batch_t;

// One acrobot: Gymnasium's `Acrobot-v1`. Call acrobot_init first. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_SIZE];
} acrobot_t;

// Why a number is out of range, as UTF-8:
// `printf("%s must be %s, got %g", error.name, error.rule, error.value)`.
typedef struct {
  double value;
  // One of acrobot_error_kind_t.
  int kind;
  // `"dt"`
  char name[24];
  // `"s"`
  char unit[16];
  // `"finite and above 0 s"`
  char rule[80];
} acrobot_error_t;

// Cosine and sine of each angle of the acrobot_state_t, and its angular velocities, rad/s; six
// floats without padding.
typedef struct {
  float cos_theta1;
  float sin_theta1;
  float cos_theta2;
  float sin_theta2;
  float dtheta1;
  float dtheta2;
} acrobot_observation_t;

// What a reset may choose. Zeros: the random numbers continue, within the task's bounds.
typedef struct {
  // A seed of any size: its words of 32 bits, the lowest first. Null: none.
  const uint32_t *seed;
  size_t seed_words;
  // The lowest and the highest number of an initial state, rad and rad/s, about upright in a
  // task that begins there. Both are finite as float. Null: those of the task.
  const double *bounds;
} acrobot_reset_options_t;

typedef struct {
  // The observation of the new state.
  acrobot_observation_t observation;
  // −1, or 0 if `terminated`.
  float reward;
  // Whether −cos θ1 − cos(θ1 + θ2) > 1: the goal.
  bool terminated;
  // Whether the time limit is reached: 500 steps by default.
  bool truncated;
} acrobot_step_t;

// A state of finite numbers. A step wraps the angles to ±π and bounds the velocities.
typedef struct {
  // Angle of link 1, rad; 0 = hanging straight down, counter-clockwise positive.
  float theta1;
  // Angle of link 2 relative to link 1, rad; 0 = in line with it.
  float theta2;
  // Angular velocity of link 1, rad/s.
  float dtheta1;
  // Angular velocity of link 2 relative to link 1, rad/s.
  float dtheta2;
} acrobot_state_t;

// To change one parameter, read all with acrobot_params, and set them.
typedef struct {
  // Length of link 1, m; above 0. Default 1.
  float length1;
  // Length of link 2, m; above 0. Only the tip's height and drawings depend on it. Default 1.
  float length2;
  // Mass of link 1, kg; above 0. Default 1.
  float mass1;
  // Mass of link 2, kg; above 0. Default 1.
  float mass2;
  // Distance of link 1's centre of mass from its joint, m; 0 or more. Default 0.5.
  float center_of_mass1;
  // Distance of link 2's centre of mass from its joint, m; 0 or more. Default 0.5.
  float center_of_mass2;
  // Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 if the
  // centre of mass is on the joint. Default 1.
  float inertia1;
  // Moment of inertia of link 2 about its centre of mass, kg m²; as `inertia1`. Default 1.
  float inertia2;
  // Acceleration of gravity, m/s², downwards; finite, 0 for none. Default 9.8.
  float gravity;
  // Duration of one step, s; above 0. Default 0.2.
  float dt;
  // Bound of |θ̇1| after a step, rad/s; at least 1.2e-38. Infinity, for none, is stored as
  // 3.4e38, the largest number in single precision, which observations have. Default 4 π.
  float max_velocity1;
  // Bound of |θ̇2| after a step, rad/s; as `max_velocity1`. Default 9 π.
  float max_velocity2;
  // Torques of the three actions, N m, in the order of their numbers; finite. Default
  // [−1, 0, 1].
  float torques[3];
  // Torque noise, N m; 0 or more. Each step adds a uniform draw from [−noise, noise) to the
  // torque; 0 draws nothing. Default 0.
  float torque_noise;
  // Viscous friction of the fixed joint, which resists θ̇1 with a torque in proportion to it,
  // N m s/rad; 0 or more. Default 0.
  float damping1;
  // Viscous friction of the elbow, which resists θ̇2; as `damping1`. Default 0.
  float damping2;
  // Coulomb friction of the fixed joint: its torque as soon as the joint turns, N m; 0 or more.
  // Default 0.
  float coulomb1;
  // Coulomb friction of the elbow; as `coulomb1`. Default 0.
  float coulomb2;
  // What a geared rotor in the elbow takes from the coupling of the links, kg m²; finite, and so
  // small that the mass matrix is positive definite. A rotor of moment of inertia J behind a
  // gear g adds (g + 1)² J to `inertia1`, g² J to `inertia2`, and (g + 1) g J here. Default 0.
  float rotor;
  // The equations of motion: of Sutton and Barto's book, or of the paper of 1996 (NIPS 8).
  // Default ACROBOT_DYNAMICS_BOOK.
  int dynamics;
} acrobot_params_t;

// How a parameter is drawn.
typedef struct {
  // One of the ACROBOT_DRAW numbers.
  int kind;
  float low;
  float high;
  float mean;
  // The standard deviation.
  float std;
} acrobot_draw_t;

// How each parameter is drawn, in the order of acrobot_params_t. Zeros draw nothing.
typedef struct {
  acrobot_draw_t length1;
  acrobot_draw_t length2;
  acrobot_draw_t mass1;
  acrobot_draw_t mass2;
  acrobot_draw_t center_of_mass1;
  acrobot_draw_t center_of_mass2;
  acrobot_draw_t inertia1;
  acrobot_draw_t inertia2;
  acrobot_draw_t gravity;
  acrobot_draw_t dt;
  acrobot_draw_t max_velocity1;
  acrobot_draw_t max_velocity2;
  acrobot_draw_t torques[3];
  acrobot_draw_t torque_noise;
  acrobot_draw_t damping1;
  acrobot_draw_t damping2;
  acrobot_draw_t coulomb1;
  acrobot_draw_t coulomb2;
  acrobot_draw_t rotor;
} acrobot_draws_t;

// How fast a state changes: angular velocities, rad/s, and accelerations, rad/s².
typedef struct {
  float dtheta1;
  float dtheta2;
  float ddtheta1;
  float ddtheta2;
} acrobot_rates_t;

// The torques and forces of a motion.
typedef struct {
  // The torques on θ1 and θ2 that the motion needs, N m. The second is that of the motor. The
  // first joint has none, so an acrobot's first torque is 0.
  float torques[2];
  // The force of the fixed joint on link 1, to the right and up, N.
  float reaction[2];
  // The same of link 1 on link 2 in the elbow.
  float elbow[2];
} acrobot_forces_t;

// The equations of motion, linearized: deviations x of the state and u of the torque have the
// rates A x + B u.
typedef struct {
  // A by rows, and B.
  float a[4][4];
  float b[4];
} acrobot_linear_model_t;

// One step of `dt`, linearized: deviations x of the state and u of the torque become A x + B u.
typedef struct {
  // A by rows, and B.
  float a[4][4];
  float b[4];
} acrobot_step_model_t;

// What a regulator weighs: xᵀ Q x + R u² for a deviation x of the state and u of the torque.
typedef struct {
  // Q by rows, 1/rad² and s²/rad²: symmetric and positive semidefinite.
  float q[4][4];
  // R, 1/(N m)²; above 0.
  float r;
} acrobot_weights_t;

// A linear-quadratic regulator.
typedef struct {
  // K of u = −K x, N m per rad and per rad/s.
  acrobot_state_t gain;
  // P by rows: xᵀ P x is the cost from x on.
  float cost_to_go[4][4];
} acrobot_lqr_t;

// The noise of a model of steps whose angles are measured.
typedef struct {
  // W, that of the noise that each step adds to x, by rows, rad², rad²/s and rad²/s²: symmetric
  // and positive semidefinite.
  float w[4][4];
  // The variances of both measurements, rad²; above 0.
  float s[2];
} acrobot_covariances_t;

// A steady-state Kalman filter.
typedef struct {
  // L by rows: the correction of x by L (y − [x1, x2]) for the measured angles y.
  float gain[4][2];
  // P by rows: the covariance of the errors before the correction.
  float prior_covariance[4][4];
} acrobot_lqe_t;

// The weights of what a plan costs, 0 or more: a larger one makes its term smaller. The defaults
// are those of acrobot_problem_init: u is the largest torque, and T² the inertia of the straight
// machine about the fixed joint, divided by the sum of the torque of gravity when it is level and
// u.
typedef struct {
  // Q of xᵀ Q x, for the deviation x from the target, by rows: 1/(rad² s), 1/rad² and s/rad²;
  // symmetric and positive semidefinite. Default 0.
  float q[4][4];
  // The same of the state after the plan: 1/rad², s/rad² and s²/rad². Default 0.
  float qf[4][4];
  // Of 2 − 2 cos x, for the deviation x of each angle from the target, 1/s: of x² where it is
  // small. Default 0.
  float angles[2];
  // R: of the square of the torque's difference from that which holds the target, 1/((N m)² s).
  // Default 0.1 / (T u²).
  float torque;
  // Of the square of the torque's change from one step to the next, 1/(N m)². Default 0.
  float torque_change;
  // Of the absolute value of the motor's power, 1/J. Default 0.
  float power;
  // Of the time that the tip is below `height`, 1/s. Default 0.4 / T.
  float below;
  // The height of the tip above the fixed joint, m, from which on `below` costs nothing. Default
  // that of the target.
  float height;
  // `below` costs half where the tip is so far below `height`, m; above 0. Default a tenth of
  // both lengths.
  float margin;
  // Of ln(1 + e) for the state after the plan, where e is 1 at the border of the region in which
  // the regulator holds. Default 20.
  float arrival;
} acrobot_cost_t;

// A machine, where it is to go, and what the way there costs.
typedef struct {
  // `dt` is the time between two decisions.
  acrobot_params_t params;
  // The largest torque, N m.
  float limit;
  // The equilibrium in which a plan ends, and the torque that holds it, N m.
  acrobot_state_t target;
  float torque;
  acrobot_cost_t cost;
} acrobot_problem_t;

// Plans motions of one machine. Call acrobot_planner_init first. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_PLANNER_SIZE];
} acrobot_planner_t;

// A step of a plan. Zeros are one without a torque.
typedef struct {
  // The state before the step.
  acrobot_state_t state;
  // N m.
  float torque;
  // K of torque − K x for the deviation x from `state`, N m per rad and per rad/s.
  acrobot_state_t gain;
  // For the planner.
  float workspace[2];
} acrobot_knot_t;

// A gain, and the region in which its torque lasts.
typedef struct {
  // K of −K x for a deviation x, N m per rad and per rad/s.
  acrobot_state_t gain;
  // F by rows: x is in the region if |F x| is below 1.
  float factor[4][4];
} acrobot_region_t;

// What holds the target after a plan. It can be a constant.
typedef struct {
  acrobot_state_t target;
  // The torque that holds the target, N m.
  float torque;
  // The gain in motion, and at rest, which is used where |F x|² is below `reach`.
  acrobot_region_t moving;
  acrobot_region_t resting;
  float reach;
} acrobot_feedback_t;

// Swings up without a plan. Call acrobot_swing_up_init first. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_SWING_UP_SIZE];
} acrobot_swing_up_t;

// Estimates the state of a machine: an extended Kalman filter. Call acrobot_estimator_init first,
// and then in each `dt` correct, decide and predict. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_ESTIMATOR_SIZE];
} acrobot_estimator_t;

// The noise of a machine.
typedef struct {
  // The standard deviation of a measured angle, rad; above 0 and at most 2. An encoder with n
  // counts for a turn has 1.8 / n.
  float angle_std;
  // The standard deviation of the torque that acts, N m; above 0, and so small that a step
  // changes θ̇2 by at most 1 / `dt`.
  float torque_std;
} acrobot_noise_t;

// As acrobot_estimator_t, and estimates parameters.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_PARAMETER_ESTIMATOR_SIZE];
} acrobot_parameter_estimator_t;

// The standard deviations of parameters, each in its unit: 0 for one that is known.
typedef struct {
  // Of the mass of link 1, kg.
  float mass1;
  // Of the mass of link 2, kg.
  float mass2;
  // Of the length of link 1, m.
  float length1;
  // Of the moment of inertia of link 1, kg m².
  float inertia1;
  // Of the moment of inertia of link 2, kg m².
  float inertia2;
  // Of the viscous friction of joint 1, N m s/rad.
  float damping1;
  // Of the viscous friction of joint 2, N m s/rad.
  float damping2;
  // Of the Coulomb friction of joint 1, N m.
  float coulomb1;
  // Of the Coulomb friction of joint 2, N m.
  float coulomb2;
  // Of the rotor, kg m².
  float rotor;
  // Of what the first encoder says where θ1 is 0, rad. It is given as 0.
  float zero1;
  // Of what the second encoder says where θ2 is 0, rad. It is given as 0.
  float zero2;
  // Of the torque that acts, divided by the one that is sent. It is given as 1.
  float torque_factor;
} acrobot_parameter_std_t;

// A regression of recordings, of constant size. Call acrobot_regression_init first. You may copy
// and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_REGRESSION_SIZE];
} acrobot_regression_t;

// A sample of a recording, in double precision.
typedef struct {
  // θ1 and θ2, rad, without jumps by whole turns.
  double angles[2];
  // The torques on θ1 and θ2 from this sample to the next, N m. An acrobot's first is 0.
  double torques[2];
} acrobot_sample_t;

// What fits recordings: the elements of the mass matrix where θ2 is ±π/2, [1, 1], [1, 2] and
// [2, 2], kg m²; the moments m1 lc1 + m2 l1 and m2 lc2, kg m; the coupling m2 l1 lc2, kg m²;
// viscous friction of both joints, N m s/rad; their Coulomb friction, N m.
typedef struct {
  double values[10];
  // Their standard errors; INFINITY for a number that the recordings do not determine.
  double std_errors[10];
  // The combination that they determine least: the part of each number.
  double weakest[10];
  // How many combinations they do not determine.
  size_t rank_deficiency;
} acrobot_fit_t;

// What acrobot_calibrate finds.
typedef struct {
  // The recorded angles where those of the machine are 0, rad.
  double zeros[2];
  // From a torque until it acts, with the time constant of the motor, s.
  double delay;
  // The root of the mean square of the errors of angles, rad, if parameters of the first two
  // thirds of the recording predict the last third, √((length1 + center_of_mass2) / gravity)
  // ahead.
  double prediction_error;
  // The standard deviation of the noise of the angles, rad, which encoders add by counting.
  double angle_noise;
  acrobot_fit_t fit;
  acrobot_params_t params;
} acrobot_calibration_t;

// What a timer's interrupt does: it estimates the state, and follows a plan of 100 decisions. Call
// acrobot_controller_init first. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_CONTROLLER_SIZE];
} acrobot_controller_t;

// A machine with encoders.
typedef struct {
  // `dt` is the time from a tick to the next.
  acrobot_params_t params;
  // The motor's largest torque, N m.
  float limit;
  // The counts of each encoder for a turn, above 0.
  int32_t counts[2];
  // The time from a torque of a tick until it acts, s, with the time constant of the motor: 0 if
  // it acts at once.
  float delay;
  // The torque is 0 while the plan is older than this, s, such as 1; INFINITY for never.
  float plan_timeout;
} acrobot_settings_t;

// What a controller knows beside the state and the parameters.
typedef struct {
  // What the encoders are estimated to say where the angles are 0, rad.
  float zeros[2];
  // The torque that is estimated to act, divided by the one that is sent.
  float torque_factor;
  // How many of the last hundred ticks have angles that no motion of the machine explains: a few
  // after a push. And 4 for each radian that a joint has turned since the other one's encoder
  // counted. Above 8 a tick is rejected.
  float misses;
  // The time since the last plan, s. It is 0 before the first one.
  float plan_age;
} acrobot_report_t;

// What the main loop does: it plans for the estimated machine while this moves. Call
// acrobot_replanner_init first. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_REPLANNER_SIZE];
} acrobot_replanner_t;

// Draws random actions: Gymnasium's `action_space`. You may copy and move it.
typedef struct ACROBOT_ALIGNED(16) {
  uint8_t bytes[ACROBOT_ACTION_SPACE_SIZE];
} acrobot_action_space_t;

// Where acrobot_batch_step writes.
typedef struct {
  // As in acrobot_step_t; 0 if the acrobot was only reset.
  float *rewards;
  // As in acrobot_step_t.
  bool *terminated;
  bool *truncated;
  // Of the new states; null if you do not need them.
  acrobot_observation_t *observations;
  // With ACROBOT_AUTORESET_SAME_STEP, those of the episodes that this step ended; other elements
  // are not written. Null if you do not need them.
  acrobot_observation_t *final_observations;
} acrobot_batch_results_t;

// What all acrobots of a batch share.
typedef struct {
  // The number of acrobots, above 0.
  size_t count;
  // An ACROBOT_TASK.
  int task;
  // Whether each acrobot has its own parameters.
  bool own_params;
  // When acrobots are reset whose episode has ended: an ACROBOT_AUTORESET.
  int autoreset;
  // Episodes are truncated after so many steps.
  uint32_t max_steps;
} acrobot_batch_settings_t;

#if defined(ACROBOT_INSTRUMENTS)
// How resets draw the instruments, in the order of acrobot_instruments_t. Zeros draw nothing:
// the numbers stay.
typedef struct {
  acrobot_draw_t action_delay;
  acrobot_draw_t observation_delay;
  acrobot_draw_t motor_lag;
  acrobot_draw_t torque_error;
  acrobot_draw_t angle_noise;
  acrobot_draw_t encoder_zero1;
  acrobot_draw_t encoder_zero2;
  acrobot_draw_t encoder_counts;
  acrobot_draw_t velocity_filter;
} acrobot_instrument_draws_t;
#endif

#if defined(ACROBOT_INSTRUMENTS)
// The motor and the sensors of an acrobot. Zeros are ideal: a torque acts at once, and the
// observation is that of the true state.
typedef struct {
  // How many steps later a torque acts: a whole number, each equally likely.
  float action_delay;
  // How many steps later an agent sees a reading: a whole number, each equally likely.
  float observation_delay;
  // The time constant of the motor, s, from 0 to 1000: the torque approaches the chosen one.
  float motor_lag;
  // The relative error of the motor's torque, from −1 to 1000: with 0.1 it is 10 % too large.
  float torque_error;
  // The standard deviation of a reading of an angle, rad, from 0 to 10.
  float angle_noise;
  // What encoder 1 reads where θ1 is 0, rad, from −π to π.
  float encoder_zero1;
  // What encoder 2 reads where θ2 is 0, rad, from −π to π.
  float encoder_zero2;
  // The counts of the encoders for a turn, from 1 to 2²²: readings are whole counts.
  float encoder_counts;
  // The time constant of a low-pass filter, s, from 0 to 1000. The agent sees filtered
  // differences of readings as velocities, and not the true ones.
  float velocity_filter;
} acrobot_instruments_t;
#endif

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The text of any status. It is constant: do not free it.
const char *acrobot_status_text(int status);

// What Rust's `Error::message` says of the `kind` of an error. It is constant: do not free it.
const char *acrobot_error_text(int kind);

// Gymnasium's `Acrobot-v1` in the state of `reset(seed=seed)`.
acrobot_status_t acrobot_init(acrobot_t *acrobot, uint64_t seed);

// As acrobot_init, for an ACROBOT_TASK with its parameters and its limit of steps.
acrobot_status_t acrobot_init_task(acrobot_t *acrobot, int task, uint64_t seed,
    acrobot_error_t *error);

// Begins an episode in a drawn initial state.
acrobot_status_t acrobot_reset(acrobot_t *acrobot, acrobot_observation_t *observation);

// As acrobot_reset after seeding: Gymnasium's `reset(seed=seed)`.
acrobot_status_t acrobot_reset_with_seed(acrobot_t *acrobot, uint64_t seed,
    acrobot_observation_t *observation);

// As acrobot_reset, with a seed of any size, or bounds of the initial state.
acrobot_status_t acrobot_reset_with(acrobot_t *acrobot, const acrobot_reset_options_t *options,
    acrobot_observation_t *observation, acrobot_error_t *error);

// Applies the torque of an ACROBOT_ACTION for one dt. After the end of an episode call
// acrobot_reset; otherwise the acrobot steps on, as in Gymnasium.
acrobot_status_t acrobot_step(acrobot_t *acrobot, int action, acrobot_step_t *step);

// Applies any finite torque, N m, for one dt. The `torques` of the parameters do not limit it.
acrobot_status_t acrobot_step_torque(acrobot_t *acrobot, float torque, acrobot_step_t *step,
    acrobot_error_t *error);

acrobot_status_t acrobot_observe(const acrobot_t *acrobot, acrobot_observation_t *observation);

// Steps since the last reset.
acrobot_status_t acrobot_elapsed_steps(const acrobot_t *acrobot, uint32_t *steps);

// Its ACROBOT_TASK.
acrobot_status_t acrobot_task(const acrobot_t *acrobot, int *task);

// Episodes are truncated after so many steps.
acrobot_status_t acrobot_max_steps(const acrobot_t *acrobot, uint32_t *max_steps);

// Sets the limit of steps, above 0.
acrobot_status_t acrobot_set_max_steps(acrobot_t *acrobot, uint32_t max_steps,
    acrobot_error_t *error);

acrobot_status_t acrobot_state(const acrobot_t *acrobot, acrobot_state_t *state);

// The number of steps stays.
acrobot_status_t acrobot_set_state(acrobot_t *acrobot, const acrobot_state_t *state,
    acrobot_error_t *error);

acrobot_status_t acrobot_params(const acrobot_t *acrobot, acrobot_params_t *params);

// Sets the parameters of the next steps. The state stays.
acrobot_status_t acrobot_set_params(acrobot_t *acrobot, const acrobot_params_t *params,
    acrobot_error_t *error);

// Draws parameters from the acrobot's generator: call it after a reset.
acrobot_status_t acrobot_draw_params(acrobot_t *acrobot, const acrobot_draws_t *draws,
    acrobot_error_t *error);

// The total energy of the state, J.
acrobot_status_t acrobot_energy(const acrobot_t *acrobot, float *energy);

// The height of the tip above the fixed joint, m.
acrobot_status_t acrobot_tip_height(const acrobot_t *acrobot, float *height);

// The default parameters of an ACROBOT_TASK.
acrobot_status_t acrobot_task_params(int task, acrobot_params_t *params, acrobot_error_t *error);

// The deviation of a state from a `target`, with angles wrapped to ±π.
acrobot_status_t acrobot_deviation_from(const acrobot_state_t *state, const acrobot_state_t *target,
    acrobot_state_t *deviation, acrobot_error_t *error);

// The rates of a state under a torque, N m, by the equations of motion.
acrobot_status_t acrobot_derivative(const acrobot_params_t *params, const acrobot_state_t *state,
    float torque, acrobot_rates_t *rates, acrobot_error_t *error);

// The mass matrix M by rows, kg m²: the kinetic energy is half of vᵀ M v for the velocities v.
acrobot_status_t acrobot_mass_matrix(const acrobot_params_t *params, const acrobot_state_t *state,
    float (*mass_matrix)[2][2], acrobot_error_t *error);

// What accelerations, rad/s², need in a state: the inverse of acrobot_derivative.
acrobot_status_t acrobot_inverse_dynamics(const acrobot_params_t *params,
    const acrobot_state_t *state, float ddtheta1, float ddtheta2, acrobot_forces_t *forces,
    acrobot_error_t *error);

// Linearizes the equations of motion about any state and torque, N m.
acrobot_status_t acrobot_linearize(const acrobot_params_t *params, const acrobot_state_t *state,
    float torque, acrobot_linear_model_t *model, acrobot_error_t *error);

// Linearizes one step about any state and torque, N m.
acrobot_status_t acrobot_linearize_step(const acrobot_params_t *params,
    const acrobot_state_t *state, float torque, acrobot_step_model_t *model,
    acrobot_error_t *error);

// The regulator that holds a machine at `target`, which must be in equilibrium under `torque`,
// N m, such as upright and 0: velocities of 0, and accelerations of at most 0.25 % of that with
// which the straight machine, when it is horizontal, falls and is turned by the torque. Decisions
// are `dt` apart. The torque is then `torque` − K x, a sum of four products; clamp it to that of
// your motor.
acrobot_status_t acrobot_regulator(const acrobot_params_t *params, const acrobot_state_t *target,
    float torque, const acrobot_weights_t *weights, acrobot_lqr_t *lqr, acrobot_error_t *error);

// The regulator of a model in continuous time: the least integral of the weights.
acrobot_status_t acrobot_lqr(const acrobot_linear_model_t *model, const acrobot_weights_t *weights,
    acrobot_lqr_t *lqr, acrobot_error_t *error);

// The regulator of a model of steps: the least sum of the weights.
acrobot_status_t acrobot_dlqr(const acrobot_step_model_t *model, const acrobot_weights_t *weights,
    acrobot_lqr_t *lqr, acrobot_error_t *error);

// The regulator along a trajectory: `models` and `gains` have an element for each step. P of
// xᵀ P x, the cost after the last step, becomes that before the first. Rejected calls may change
// gains.
acrobot_status_t acrobot_tvlqr(const acrobot_step_model_t *models, const acrobot_weights_t *weights,
    float (*cost_to_go)[4][4], acrobot_state_t *gains, size_t count, acrobot_error_t *error);

// The Kalman filter of a model of steps: the least variances of its errors after many steps.
acrobot_status_t acrobot_dlqe(const acrobot_step_model_t *model,
    const acrobot_covariances_t *covariances, acrobot_lqe_t *lqe, acrobot_error_t *error);

// The problem to stand with an `elbow` angle, rad, for a largest torque, N m: 0 is a swing-up. It
// has the default weights, which follow from the size of the machine. Then you may change them.
acrobot_status_t acrobot_problem_init(acrobot_problem_t *problem, const acrobot_params_t *params,
    float limit, float elbow, acrobot_error_t *error);

// No velocity of a plan reaches its bound.
acrobot_status_t acrobot_planner_init(acrobot_planner_t *planner, const acrobot_problem_t *problem,
    acrobot_error_t *error);

// Changes a planner to plan for a simulation that clamps velocities at the bounds of its
// parameters, as Gymnasium's does. Plans may use that as a brake.
acrobot_status_t acrobot_planner_with_velocity_clamp(acrobot_planner_t *planner);

// Plans until a plan ends where the regulator holds the target. `length` receives its number of
// knots, which are the first. `error` names the `tries` if so many find no plan. Rejected calls
// may change knots.
acrobot_status_t acrobot_planner_plan(acrobot_planner_t *planner, const acrobot_state_t *start,
    uint32_t tries, uint64_t seed, acrobot_knot_t *knots, size_t count, size_t *length,
    acrobot_error_t *error);

// Improves a plan, or the rest of one, by at most so many iterations: from the state `start` on.
// `plan` stays as it is, so the machine may follow it meanwhile. `improved` receives the new plan,
// and `cost` what it costs. Rejected calls may change `improved`.
acrobot_status_t acrobot_planner_improve(acrobot_planner_t *planner, const acrobot_state_t *start,
    uint32_t iterations, const acrobot_knot_t *plan, acrobot_knot_t *improved, size_t length,
    float *cost, acrobot_error_t *error);

// What holds the target after each plan.
acrobot_status_t acrobot_planner_feedback(const acrobot_planner_t *planner,
    acrobot_feedback_t *feedback);

// Whether this feedback, with the largest torque, takes the machine from a state to the target.
acrobot_status_t acrobot_planner_holds_from(const acrobot_planner_t *planner,
    const acrobot_state_t *state, bool *holds, acrobot_error_t *error);

// The torque at a step of a plan, N m, and after it that of the feedback. Clamp it to that of your
// motor. It needs no planner, so knots and feedback may be constants.
acrobot_status_t acrobot_plan_torque(const acrobot_knot_t *knots, size_t length,
    const acrobot_feedback_t *after, size_t step, const acrobot_state_t *state, float *torque,
    acrobot_error_t *error);

// For a machine with these parameters, whose `dt` is the time between two decisions, and a largest
// torque, N m.
acrobot_status_t acrobot_swing_up_init(acrobot_swing_up_t *swing_up, const acrobot_params_t *params,
    float limit, acrobot_error_t *error);

// The torque without a plan, N m, at most the largest. It pumps energy until the regulator holds.
acrobot_status_t acrobot_swing_up_torque(acrobot_swing_up_t *swing_up, const acrobot_state_t *state,
    float *torque, acrobot_error_t *error);

// Estimates the state of a machine with these parameters. The first measurement sets it.
acrobot_status_t acrobot_estimator_init(acrobot_estimator_t *filter, const acrobot_params_t *params,
    const acrobot_noise_t *noise, acrobot_error_t *error);

// Corrects the estimate by measured angles, rad. The first ones are taken as they are, with
// velocities of 0.
acrobot_status_t acrobot_estimator_correct(acrobot_estimator_t *filter, float theta1, float theta2,
    acrobot_error_t *error);

// Takes a step of `dt` with a torque, N m. Before a measurement it does nothing. If a joint turns
// by more than half a turn in the step, or a number overflows, it is rejected, and the next
// measurement begins again.
acrobot_status_t acrobot_estimator_predict(acrobot_estimator_t *filter, float torque,
    acrobot_error_t *error);

acrobot_status_t acrobot_estimator_state(const acrobot_estimator_t *filter, acrobot_state_t *state);

// The standard deviations of the state; INFINITY before a measurement.
acrobot_status_t acrobot_estimator_state_std(const acrobot_estimator_t *filter,
    acrobot_state_t *std);

// Estimates the state, and the parameters whose standard deviation is not 0.
acrobot_status_t acrobot_parameter_estimator_init(acrobot_parameter_estimator_t *filter,
    const acrobot_params_t *params, const acrobot_parameter_std_t *std,
    const acrobot_noise_t *noise, acrobot_error_t *error);

// As acrobot_estimator_correct.
acrobot_status_t acrobot_parameter_estimator_correct(acrobot_parameter_estimator_t *filter,
    float theta1, float theta2, acrobot_error_t *error);

// As acrobot_estimator_predict.
acrobot_status_t acrobot_parameter_estimator_predict(acrobot_parameter_estimator_t *filter,
    float torque, acrobot_error_t *error);

acrobot_status_t acrobot_parameter_estimator_state(const acrobot_parameter_estimator_t *filter,
    acrobot_state_t *state);

// As acrobot_estimator_state_std.
acrobot_status_t acrobot_parameter_estimator_state_std(const acrobot_parameter_estimator_t *filter,
    acrobot_state_t *std);

// The estimated parameters, and those that are known.
acrobot_status_t acrobot_parameter_estimator_params(const acrobot_parameter_estimator_t *filter,
    acrobot_params_t *params);

// What the encoders are estimated to say where the angles are 0, rad, and the torque that is
// estimated to act, divided by the one of acrobot_parameter_estimator_predict.
acrobot_status_t acrobot_parameter_estimator_errors(const acrobot_parameter_estimator_t *filter,
    float (*errors)[3]);

// No recording.
acrobot_status_t acrobot_regression_init(acrobot_regression_t *regression);

// Adds a recording with a sample in each `dt`, s, of a machine under `gravity`, m/s². A velocity
// is that of a parabola through 2 `half` + 1 angles, and a window has so many samples; the next
// one begins in its middle. Both are above 0. A recording that is too short adds nothing.
acrobot_status_t acrobot_regression_add(acrobot_regression_t *regression,
    const acrobot_sample_t *samples, size_t count, double dt, double gravity, size_t half,
    size_t window, acrobot_error_t *error);

// The numbers that fit the recordings best.
acrobot_status_t acrobot_regression_fit(const acrobot_regression_t *regression, acrobot_fit_t *fit);

// The parameters of a fit: those of `given` with the length of link 1, masses, inertias, rotor and
// friction that move as the machine does. Rejected if no machine has these numbers, or the
// recordings do not determine one that is not a friction.
acrobot_status_t acrobot_fit_params(const acrobot_fit_t *fit, const acrobot_params_t *given,
    acrobot_params_t *params, acrobot_error_t *error);

// The parameters of a recording with a sample in each `dt` of `given`, whose lengths should be
// about right, too. Tries many windows, and takes those that predict best. Believes the recording:
// acrobot_calibrate finds or names wrong signs, zeros, a delay and lost samples.
acrobot_status_t acrobot_identify(const acrobot_sample_t *samples, size_t count,
    const acrobot_params_t *given, acrobot_params_t *params, acrobot_error_t *error);

// The zeros of both encoders, the delay and the parameters of a recording with a sample in each
// `dt` of `given`, whose lengths should be about right, too. Rejected if more than 0.5 % of the
// samples are lost, more than 3 % of the torques is unexplained, a number is not known within 3 %,
// a link hardly moved, an angle or the torque has the wrong sign, the second angle is not that
// from link 1, a zero is beyond 0.5 rad, or the masses are not within a factor of 30 of those
// given.
acrobot_status_t acrobot_calibrate(const acrobot_sample_t *samples, size_t count,
    const acrobot_params_t *given, acrobot_calibration_t *calibration, acrobot_error_t *error);

// The root of the mean square of the errors of angles, rad, if they are predicted `horizon` steps
// ahead; 0 for a recording that is too short.
acrobot_status_t acrobot_prediction_error(const acrobot_params_t *params,
    const acrobot_sample_t *samples, size_t count, size_t horizon, double *prediction_error,
    acrobot_error_t *error);

// A controller without a plan: its torque is 0.
acrobot_status_t acrobot_controller_init(acrobot_controller_t *controller,
    const acrobot_settings_t *settings, acrobot_error_t *error);

// The torque from now to the next tick, N m, from what both encoders count. It is short. If it is
// rejected, switch the motor off: a number is not finite, or no motion of the machine explains
// what the encoders count.
acrobot_status_t acrobot_controller_tick(acrobot_controller_t *controller, int32_t count1,
    int32_t count2, float *torque, acrobot_error_t *error);

// The estimated state.
acrobot_status_t acrobot_controller_state(const acrobot_controller_t *controller,
    acrobot_state_t *state);

// The estimated parameters.
acrobot_status_t acrobot_controller_params(const acrobot_controller_t *controller,
    acrobot_params_t *params);

// What the controller knows beside the state and the parameters.
acrobot_status_t acrobot_controller_report(const acrobot_controller_t *controller,
    acrobot_report_t *report);

// A replanner without a plan.
acrobot_status_t acrobot_replanner_init(acrobot_replanner_t *replanner,
    const acrobot_settings_t *settings, acrobot_error_t *error);

// Gives the controller the plan once it is due, and takes the estimates. It is short, and no tick
// may come meanwhile: switch the interrupt off.
acrobot_status_t acrobot_replanner_exchange(acrobot_replanner_t *replanner,
    acrobot_controller_t *controller);

// Plans for some milliseconds to tens of them: once after each acrobot_replanner_exchange. The
// interrupt may stop it anywhere.
acrobot_status_t acrobot_replanner_work(acrobot_replanner_t *replanner);

// Gymnasium's `action_space.seed(seed)`.
acrobot_status_t acrobot_action_space_init(acrobot_action_space_t *action_space, uint64_t seed);

// As acrobot_action_space_init, with a seed of any size: its words of 32 bits, the lowest first.
acrobot_status_t acrobot_action_space_init_with(acrobot_action_space_t *action_space,
    const uint32_t *seed, size_t seed_words);

// Draws an action, all equally likely: Gymnasium's `action_space.sample()`.
acrobot_status_t acrobot_action_space_sample(acrobot_action_space_t *action_space, uint8_t *action);

// Draws an action for each acrobot of a batch: `sample()` of Gymnasium's `MultiDiscrete`.
acrobot_status_t acrobot_action_space_sample_each(acrobot_action_space_t *action_space,
    uint8_t *actions, size_t count);

// ACROBOT_BATCH_SIZE(count), or with `own_params` ACROBOT_BATCH_OWN_SIZE(count), but at most
// SIZE_MAX.
size_t acrobot_batch_size(size_t count, bool own_params);

// Makes a batch of an ACROBOT_TASK in `memory`, which has `size` bytes, with the task's
// parameters, in initial states. Acrobot `i` is seeded with NumPy's
// `SeedSequence(seed).spawn(count)[i]`. `batch` receives the batch's address. With `own_params`
// acrobots can have different parameters.
acrobot_status_t acrobot_batch_init(void *memory, size_t size, size_t count, int task,
    bool own_params, uint64_t seed, acrobot_batch_t **batch);

// Applies an action to each acrobot for one dt. If one is rejected, no acrobot steps, but
// `terminated` and `truncated` become false.
acrobot_status_t acrobot_batch_step(acrobot_batch_t *batch, const uint8_t *actions,
    const acrobot_batch_results_t *results, size_t count);

// As acrobot_batch_step, with any finite torques, N m.
acrobot_status_t acrobot_batch_step_torque(acrobot_batch_t *batch, const float *torques,
    const acrobot_batch_results_t *results, size_t count);

acrobot_status_t acrobot_batch_observe(const acrobot_batch_t *batch,
    acrobot_observation_t *observations, size_t count);

acrobot_status_t acrobot_batch_settings(const acrobot_batch_t *batch,
    acrobot_batch_settings_t *settings);

// As acrobot_reset, for each acrobot.
acrobot_status_t acrobot_batch_reset(acrobot_batch_t *batch);

// As acrobot_reset_with, for each acrobot, seeded as acrobot_batch_init does.
acrobot_status_t acrobot_batch_reset_with(acrobot_batch_t *batch,
    const acrobot_reset_options_t *options, acrobot_error_t *error);

// As acrobot_batch_reset, after seeding acrobot `i` as acrobot_reset_with_seed does.
acrobot_status_t acrobot_batch_reset_with_seeds(acrobot_batch_t *batch, const uint64_t *seeds,
    size_t count);

// As acrobot_batch_reset_with, where `mask` is true. A byte that is neither true nor false is
// rejected.
acrobot_status_t acrobot_batch_reset_masked(acrobot_batch_t *batch, const bool *mask, size_t count,
    const acrobot_reset_options_t *options, acrobot_error_t *error);

// When acrobots are reset whose episode has ended: an ACROBOT_AUTORESET.
acrobot_status_t acrobot_batch_set_autoreset(acrobot_batch_t *batch, int autoreset,
    acrobot_error_t *error);

// As acrobot_set_max_steps, for all acrobots.
acrobot_status_t acrobot_batch_set_max_steps(acrobot_batch_t *batch, uint32_t max_steps,
    acrobot_error_t *error);

acrobot_status_t acrobot_batch_state(const acrobot_batch_t *batch, size_t index,
    acrobot_state_t *state);

// The number of its steps stays.
acrobot_status_t acrobot_batch_set_state(acrobot_batch_t *batch, size_t index,
    const acrobot_state_t *state, acrobot_error_t *error);

// The steps of an acrobot since its last reset.
acrobot_status_t acrobot_batch_elapsed_steps(const acrobot_batch_t *batch, size_t index,
    uint32_t *steps);

// Whether the episode of an acrobot has ended and it waits for a reset.
acrobot_status_t acrobot_batch_is_done(const acrobot_batch_t *batch, size_t index, bool *is_done);

acrobot_status_t acrobot_batch_params(const acrobot_batch_t *batch, size_t index,
    acrobot_params_t *params);

// As acrobot_set_params, for one acrobot of a batch with own parameters.
acrobot_status_t acrobot_batch_set_params(acrobot_batch_t *batch, size_t index,
    const acrobot_params_t *params, acrobot_error_t *error);

// As acrobot_set_params, for all acrobots.
acrobot_status_t acrobot_batch_set_all_params(acrobot_batch_t *batch,
    const acrobot_params_t *params, acrobot_error_t *error);

// From now on each reset of a batch with own parameters draws them, after the initial state and
// from the same random numbers. Zeros end it.
acrobot_status_t acrobot_batch_set_draws(acrobot_batch_t *batch, const acrobot_draws_t *draws,
    acrobot_error_t *error);

#if defined(ACROBOT_INSTRUMENTS)
// From now on each reset draws the instruments of each acrobot, after the initial state and from
// the same random numbers. A delay is a whole number up to ACROBOT_LONGEST_DELAY, drawn uniformly.
acrobot_status_t acrobot_batch_set_instrument_draws(acrobot_batch_t *batch,
    const acrobot_instrument_draws_t *draws, acrobot_error_t *error);
#endif

#if defined(ACROBOT_INSTRUMENTS)
// The instruments of an acrobot: those that the last reset drew, or that were set.
acrobot_status_t acrobot_batch_instruments(const acrobot_batch_t *batch, size_t index,
    acrobot_instruments_t *instruments);
#endif

#if defined(ACROBOT_INSTRUMENTS)
// Sets the instruments of an acrobot, until a reset draws them. All acrobots of a batch have the
// kinds of instruments that one has, so with a `velocity_filter` all see differences of readings,
// which are not filtered where it is 0.
acrobot_status_t acrobot_batch_set_instruments(acrobot_batch_t *batch, size_t index,
    const acrobot_instruments_t *instruments, acrobot_error_t *error);
#endif

#if defined(ACROBOT_INSTRUMENTS)
// As acrobot_batch_set_instruments, for all acrobots. Where a number is 0 and resets draw none,
// all are ideal.
acrobot_status_t acrobot_batch_set_all_instruments(acrobot_batch_t *batch,
    const acrobot_instruments_t *instruments, acrobot_error_t *error);
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// Writes a snapshot into `bytes`, which has `size` bytes: ACROBOT_SNAPSHOT_SIZE is enough. An
// acrobot that loads it continues with the same bits, in any language.
acrobot_status_t acrobot_save(const acrobot_t *acrobot, uint8_t *bytes, size_t size,
    size_t *length);
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// Makes an acrobot of a snapshot.
acrobot_status_t acrobot_load(acrobot_t *acrobot, const uint8_t *bytes, size_t length);
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// Bytes of a snapshot of a batch of `count` acrobots, at most.
size_t acrobot_batch_snapshot_size(size_t count);
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// As acrobot_save, for a batch.
acrobot_status_t acrobot_batch_save(const acrobot_batch_t *batch, uint8_t *bytes, size_t size,
    size_t *length);
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// The number of acrobots in a snapshot of a batch, and whether they have own parameters.
// acrobot_batch_size of these is the memory that acrobot_batch_load needs.
acrobot_status_t acrobot_batch_saved_count(const uint8_t *bytes, size_t length, size_t *count,
    bool *own_params);
#endif

#if (defined(ACROBOT_HAS_SNAPSHOTS) || defined(__wasm__))
// Makes a batch of a snapshot in `memory`, which has `size` bytes. `batch` receives its address.
acrobot_status_t acrobot_batch_load(void *memory, size_t size, const uint8_t *bytes, size_t length,
    acrobot_batch_t **batch);
#endif

#if defined(__wasm__)
// `size` bytes of zeros, aligned for any type of the header; null without memory.
uint8_t *acrobot_memory_new(size_t size);
#endif

#if defined(__wasm__)
// Frees memory of acrobot_memory_new, with its size.
void acrobot_memory_free(uint8_t *memory, size_t size);
#endif

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif // ACROBOT_H
