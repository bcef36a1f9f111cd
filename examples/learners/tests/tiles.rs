//! Properties of a tile coder: which tiles change, and how many.

use std::collections::BTreeSet;

use learners::{Dimension, Features, Group, Place, Table, TileCoder, displacement};
use rand_core::Rng;
use rand_pcg::Pcg32;

const UNIT: Dimension = Dimension::bounded(0.0, 1.0, 4);
const CIRCLE: Dimension = Dimension::cyclic(-1.0, 1.0, 5);
const SPACE: [Dimension; 4] = [CIRCLE, UNIT, UNIT, UNIT];

fn eight(table: Table) -> TileCoder<4, 8> {
    TileCoder::new(SPACE, &[Group::new(&[0, 1, 2, 3], 8)], table, displacement).unwrap()
}

fn changed<const T: usize>(a: [u16; T], b: [u16; T]) -> usize {
    a.iter().zip(b).filter(|&(a, b)| *a != b).count()
}

/// Uniform in [−1, 1) for the circle and in [0, 1) for the others.
fn anywhere(rng: &mut Pcg32) -> [f32; 4] {
    let mut draw = || (rng.next_u32() >> 8) as f32 / 16_777_216.0;
    [2.0 * draw() - 1.0, draw(), draw(), draw()]
}

/// Each odd displacement is coprime to 8, so the borders of eight tilings are an eighth of an interval apart in
/// each dimension.
#[test]
fn an_eighth_of_an_interval_changes_one_tile_of_eight() {
    let coder = eight(Table::Direct);
    let mut rng = Pcg32::new(1, 1);
    for _ in 0..1000 {
        // In the middle between borders, where rounding changes nothing.
        let mut x = anywhere(&mut rng).map(|x| ((x * 32.0).floor() + 0.5) / 32.0);
        x[0] = (rng.next_u32() % 40) as f32 / 20.0 - 1.0 + 0.025;
        for (d, eighth) in [0.05, 1.0 / 32.0, 1.0 / 32.0, 1.0 / 32.0]
            .into_iter()
            .enumerate()
        {
            for steps in 1..=8 {
                let mut moved = x;
                moved[d] += steps as f32 * eighth;
                let inside = d == 0 || moved[d] < 1.0;
                let count = changed(coder.active(&x), coder.active(&moved));
                assert!(
                    !inside || count == steps,
                    "{x:?}, dimension {d}: {count} for {steps}"
                );
            }
        }
    }
}

#[test]
fn displacement_is_by_odd_integers() {
    let offset = |tiling, dimension| {
        displacement(Place {
            group: 0,
            tiling,
            tilings: 8,
            dimension,
        })
    };
    assert_eq!(
        [0, 1, 2, 3].map(|d| offset(1, d)),
        [0.125, 0.375, 0.625, 0.875]
    );
    assert_eq!(
        [0, 1, 2, 3].map(|d| offset(3, d)),
        [0.375, 0.125, 0.875, 0.625]
    );
}

#[test]
fn cyclic_numbers_wrap_around() {
    let coder = eight(Table::Direct);
    let at = |x| coder.active(&[x, 0.3, 0.3, 0.3]);
    assert_eq!(changed(at(-0.975), at(0.975)), 1);
    for x in [-0.975, -0.31, 0.024, 0.77] {
        for turns in [-3.0, -1.0, 1.0, 2.0] {
            assert_eq!(at(x), at(x + 2.0 * turns), "{x} and {turns} turns");
        }
    }
    assert_eq!(at(-1.0), at(1.0));
    // After five intervals the first tile follows, not a sixth.
    let distinct: BTreeSet<_> = (0..1000).map(|n| at(n as f32 / 500.0 - 1.0)[3]).collect();
    assert_eq!(distinct.len(), 5);
}

#[test]
fn numbers_beyond_a_bound_count_as_the_bound() {
    let coder = eight(Table::Direct);
    let at = |x| coder.active(&[0.1, x, 0.3, 0.3]);
    for (beyond, bound) in [
        (-5.0, 0.0),
        (f32::NEG_INFINITY, 0.0),
        (7.0, 1.0),
        (f32::INFINITY, 1.0),
    ] {
        assert_eq!(at(beyond), at(bound), "{beyond}");
    }
    assert_ne!(at(0.0), at(1.0));
}

#[test]
fn tilings_share_no_slots_without_hashing() {
    let groups = [
        Group::new(&[0, 1], 3),
        Group::new(&[1, 2, 3], 2),
        Group::new(&[2], 1),
    ];
    let offset = |place: Place| (place.tiling + place.dimension) as f32 / 5.0;
    let coder = TileCoder::<4, 6>::new(SPACE, &groups, Table::Direct, offset).unwrap();
    assert_eq!(coder.slots(), 3 * 5 * 5 + 2 * 5 * 5 * 5 + 5);
    let mut owners = vec![None; coder.slots()];
    let mut rng = Pcg32::new(2, 1);
    for _ in 0..100_000 {
        for (tiling, slot) in coder.active(&anywhere(&mut rng)).into_iter().enumerate() {
            assert!(
                owners[usize::from(slot)].is_none_or(|owner| owner == tiling),
                "slot {slot}"
            );
            owners[usize::from(slot)] = Some(tiling);
        }
    }
    // Tilings without an offset in a bounded dimension never need the interval beyond the bounds.
    let unused = owners.iter().filter(|owner| owner.is_none()).count();
    assert_eq!(unused, 5 * 5 + 1, "never used");
}

#[test]
fn a_tiling_depends_only_on_its_dimensions() {
    let groups = [Group::new(&[0, 2], 2), Group::new(&[3], 1)];
    let coder = TileCoder::<4, 3>::new(SPACE, &groups, Table::Hashed(64), displacement).unwrap();
    let [a, b, c] = coder.active(&[0.1, 0.1, 0.1, 0.1]);
    assert_eq!(coder.active(&[0.1, 0.9, 0.1, 0.1]), [a, b, c]);
    let [d, e, f] = coder.active(&[0.1, 0.1, 0.1, 0.9]);
    assert!((a, b) == (d, e) && c != f);
    let [d, e, f] = coder.active(&[0.7, 0.1, 0.1, 0.1]);
    assert!(a != d && b != e && c == f);
}

/// With random slots, a seventh to a quarter of the 320 to 625 tiles of a tiling would share one.
#[test]
fn hashing_spreads_the_tiles() {
    let coders = [eight(Table::Direct), eight(Table::Hashed(1024))];
    let mut rng = Pcg32::new(3, 1);
    let mut slots = [(); 2].map(|()| vec![BTreeSet::new(); 8]);
    for _ in 0..100_000 {
        let x = anywhere(&mut rng);
        for (slots, coder) in slots.iter_mut().zip(&coders) {
            for (slots, slot) in slots.iter_mut().zip(coder.active(&x)) {
                slots.insert(slot);
            }
        }
    }
    let [tiles, slots] = slots;
    for (tiling, (tiles, slots)) in tiles.iter().zip(&slots).enumerate() {
        let (tiles, slots) = (tiles.len(), slots.len());
        assert!(
            slots * 20 > tiles * 19,
            "tiling {tiling}: {slots} slots for {tiles} tiles"
        );
    }
    assert!(slots.iter().flatten().all(|&slot| slot < 1024));
    // All tilings together use the whole table.
    assert!(slots.iter().flatten().collect::<BTreeSet<_>>().len() > 900);
}

#[test]
fn any_number_gives_slots_of_the_table() {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        1e-45,
        -1e-45,
        -0.0,
    ];
    for coder in [eight(Table::Direct), eight(Table::Hashed(32))] {
        for x in odd {
            for d in 0..4 {
                let mut state = [0.5; 4];
                state[d] = x;
                let slots = coder.active(&state);
                assert!(
                    slots.iter().all(|&slot| usize::from(slot) < coder.slots()),
                    "{x}"
                );
            }
        }
    }
}
