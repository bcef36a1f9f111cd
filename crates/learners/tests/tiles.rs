//! Properties of a tile coder.

use std::collections::BTreeSet;
use std::f32::consts::PI;

use learners::TileCoder;

/// Six intervals for each angle, five and six for the velocities. The first eight tilings are over
/// all dimensions, then come two for each of four pairs.
type Few = TileCoder<1408, 16>;

/// The bounds of the state.
const BOUNDS: [f32; 4] = [PI, PI, 1.125 * PI, 2.25 * PI];

fn changed(a: &[u16], b: &[u16]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn angles_are_cyclic() {
    let coder = Few::new();
    for d in 0..2 {
        let at = |x| {
            let mut state = [0.1; 4];
            state[d] = x;
            coder.active(&state)
        };
        assert_eq!(at(-PI), at(PI));
        // A sixteenth of an interval on both sides.
        assert_eq!(changed(&at(-PI + 0.07)[..8], &at(PI - 0.07)[..8]), 1);
        // After six intervals the first tile follows, not a seventh.
        let distinct: BTreeSet<_> = (-99..=99).map(|n| at(n as f32 / 100.0 * PI)[3]).collect();
        assert_eq!(distinct.len(), 6);
    }
}

/// Also infinities, NaN and numbers that are almost 0.
#[test]
fn velocities_beyond_a_bound_count_as_the_bound_and_every_slot_is_in_the_table() {
    let coder = TileCoder::<32, 16>::new();
    for d in 0..4 {
        let at = |x| {
            let mut state = [0.5; 4];
            state[d] = x;
            let slots = coder.active(&state);
            assert!(slots.iter().all(|&slot| slot < 32), "{x}");
            slots
        };
        for x in [f32::NAN, 1e-45, -1e-45, -0.0] {
            at(x);
        }
        for x in [1e9, f32::MAX, f32::INFINITY] {
            let ends = [-x, x].map(at);
            assert!(d < 2 || ends == [-BOUNDS[d], BOUNDS[d]].map(at), "{x}");
        }
        assert!(d < 2 || at(-BOUNDS[d]) != at(BOUNDS[d]));
    }
}
