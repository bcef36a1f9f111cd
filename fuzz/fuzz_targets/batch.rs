//! A batch of any length and block, and its acrobots one by one: the same bits, whatever is set.

#![no_main]

use std::num::NonZeroU32;

use acrobot::{
    Acrobot, Arithmetic, Autoreset, Batch, Block, Error, Fast, Member, Observations, Output,
    Params, Pcg64, Portable, SeedSequence, StartBounds, State, Vectors,
};
use acrobot_fuzz::{assert_settled, number, params, state};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut u = Unstructured::new(bytes);
    let _ = match u.int_in_range(0..=3) {
        Ok(0) => sequence::<Fast, 1>(&mut u),
        Ok(1) => sequence::<Fast, 3>(&mut u),
        Ok(2) => sequence::<Portable, 4>(&mut u),
        _ => sequence::<Fast, 16>(&mut u),
    };
});

/// One acrobot as a batch has it.
struct Alone<A: Arithmetic> {
    acrobot: Acrobot<A>,
    elapsed: u32,
    ended: bool,
}

/// What a step returns of one, and its last observation where the step ended and reset it.
type Returned = ([f32; 6], f32, bool, bool, Option<[f32; 6]>);

impl<A: Arithmetic> Alone<A> {
    /// By the same step none waits for its reset.
    fn settle(&mut self, settings: &Settings) {
        if self.ended && settings.autoreset == Autoreset::SameStep {
            self.acrobot.reset_within(settings.bounds);
            self.begin();
        }
    }

    fn begin(&mut self) {
        (self.elapsed, self.ended) = (0, false);
    }

    fn step(&mut self, action: u8, settings: &Settings) -> std::result::Result<Returned, Error> {
        if self.ended && settings.autoreset == Autoreset::NextStep {
            // The action is ignored, and the noise is not drawn.
            self.begin();
            return Ok((
                *self.acrobot.reset_within(settings.bounds),
                0.0,
                false,
                false,
                None,
            ));
        }
        let step = self.acrobot.step(action.try_into()?);
        self.elapsed = self.elapsed.saturating_add(1);
        let truncated = self.elapsed >= settings.limit.get();
        self.ended = step.terminated || truncated;
        let mut seen = (*step.observation, None);
        if self.ended && settings.autoreset == Autoreset::SameStep {
            seen = (*self.acrobot.reset_within(settings.bounds), Some(seen.0));
            self.begin();
        }
        Ok((seen.0, step.reward, step.terminated, truncated, seen.1))
    }

    fn member(&self) -> Member<A::Scalar> {
        Member {
            state: self.acrobot.state(),
            elapsed: self.elapsed,
            ended: self.ended,
            rng: self.acrobot.rng().clone(),
        }
    }
}

const MODES: [Autoreset; 2] = [Autoreset::NextStep, Autoreset::SameStep];

struct Settings {
    autoreset: Autoreset,
    bounds: StartBounds,
    limit: NonZeroU32,
}

fn sequence<A: Arithmetic, const N: usize>(u: &mut Unstructured<'_>) -> Result<()> {
    let len: usize = u.int_in_range(1..=35)?;
    let seed = u.arbitrary::<u64>()?;
    let blocks = vec![Block::EMPTY; len.div_ceil(N)];
    let batch = Batch::<A, _, _, N>::new(seed, blocks, vec![Pcg64::UNSEEDED; len]);
    let mut batch = batch.expect("it has a block for each N");
    let mut alone: Vec<_> = SeedSequence::from(seed)
        .spawn(len as u64)
        .map(alone)
        .collect();
    let mut settings = Settings {
        autoreset: *u.choose(&MODES)?,
        bounds: StartBounds::DEFAULT,
        limit: u.arbitrary()?,
    };
    batch.set_autoreset(settings.autoreset);
    batch.set_limit(settings.limit);
    batch.set_vectors(*u.choose(&[Vectors::Baseline, Vectors::Avx2, Vectors::Avx512])?);
    while !u.is_empty() {
        match u.int_in_range(0..=9)? {
            0 => {
                let params: Params<A::Scalar> = params(u)?.cast();
                let set = batch.set_params(params);
                for alone in &mut alone {
                    assert_eq!(alone.acrobot.set_params(params).is_ok(), set.is_ok());
                }
            }
            1 => {
                if let Ok(bounds) = StartBounds::new(number(u, -0.1)?, number(u, 0.1)?) {
                    settings.bounds = bounds;
                    batch.set_start_bounds(bounds);
                }
            }
            2 => {
                batch.reset();
                for alone in &mut alone {
                    alone.acrobot.reset_within(settings.bounds);
                    alone.begin();
                }
            }
            3 => {
                let state: State<A::Scalar> = state(u)?.cast();
                let mut states = vec![state; u.int_in_range(len - 1..=len + 1)?];
                if let Some(last) = states.last_mut() {
                    *last = State::default();
                }
                let reset = batch.reset_to(&states);
                let valid = states.iter().all(|state| state.validate().is_ok());
                assert_eq!(reset.is_ok(), valid && states.len() == len);
                for (alone, state) in alone.iter_mut().zip(states).filter(|_| reset.is_ok()) {
                    assert!(alone.acrobot.set_state(state).is_ok());
                    alone.begin();
                }
            }
            4 => {
                let member = Member {
                    state: state(u)?.cast(),
                    elapsed: u.arbitrary()?,
                    ended: u.arbitrary()?,
                    rng: Pcg64::new(u.arbitrary::<u64>()?),
                };
                let index = u.int_in_range(0..=len + N)?;
                let put = batch.set_member(index, member.clone());
                assert_eq!(put.is_ok(), member.state.validate().is_ok() && index < len);
                if let Some(alone) = alone.get_mut(index).filter(|_| put.is_ok()) {
                    assert!(alone.acrobot.set_state(member.state).is_ok());
                    *alone.acrobot.rng_mut() = member.rng;
                    (alone.elapsed, alone.ended) = (member.elapsed, member.ended);
                    alone.settle(&settings);
                }
            }
            5 => {
                settings.autoreset = *u.choose(&MODES)?;
                settings.limit = u.arbitrary()?;
                batch.set_autoreset(settings.autoreset);
                batch.set_limit(settings.limit);
                alone.iter_mut().for_each(|alone| alone.settle(&settings));
            }
            _ => step(&mut batch, &mut alone, &settings, u)?,
        }
        for (index, alone) in alone.iter().enumerate() {
            assert_eq!(batch.member(index), Some(alone.member()), "acrobot {index}");
        }
        assert_eq!((batch.member(len), batch.state(len)), (None, None));
    }
    Ok(())
}

fn alone<A: Arithmetic>(seed: SeedSequence) -> Alone<A> {
    Alone {
        acrobot: Acrobot::new(seed),
        elapsed: 0,
        ended: false,
    }
}

fn step<A: Arithmetic, const N: usize>(
    batch: &mut Batch<A, Vec<Block<A::Scalar, N>>, Vec<Pcg64>, N>,
    alone: &mut [Alone<A>],
    settings: &Settings,
    u: &mut Unstructured<'_>,
) -> Result<()> {
    let len = alone.len();
    // Now and then a number that is none, or one too few.
    let last = *u.choose(&[0, 1, 2, 0, 1, 2, 0, 1, 2, 3, u8::MAX])?;
    let found = len - usize::from(u.ratio(1, 16)?);
    let mut actions: Vec<u8> = (0..found)
        .map(|_| u.int_in_range(0..=2))
        .collect::<Result<_>>()?;
    if let Some(action) = actions.last_mut() {
        *action = last;
    }
    const UNTOUCHED: f32 = 9.0;
    let (mut rewards, mut terminated, mut truncated) =
        (vec![UNTOUCHED; len], vec![false; len], vec![false; len]);
    let (mut rows, mut finals) = (vec![[UNTOUCHED; 6]; len], vec![[UNTOUCHED; 6]; len]);
    let output = Output {
        rewards: &mut rewards,
        terminated: &mut terminated,
        truncated: &mut truncated,
        observations: Observations::Rows(&mut rows),
        final_observations: Observations::Rows(&mut finals),
    };
    let stepped = batch.step(&actions, output);
    assert_eq!(
        stepped.is_ok(),
        found == len && actions.iter().all(|&action| action < 3)
    );
    if stepped.is_err() {
        assert_eq!(
            (rewards, rows),
            (vec![UNTOUCHED; len], vec![[UNTOUCHED; 6]; len])
        );
        return Ok(());
    }
    for (index, alone) in alone.iter_mut().enumerate() {
        let (row, reward, goal, last, final_row) = alone
            .step(actions[index], settings)
            .expect("a known action");
        assert_eq!(
            rows[index].map(f32::to_bits),
            row.map(f32::to_bits),
            "acrobot {index}"
        );
        assert_eq!(
            finals[index],
            final_row.unwrap_or([UNTOUCHED; 6]),
            "acrobot {index}"
        );
        assert_eq!(
            (rewards[index], terminated[index], truncated[index]),
            (reward, goal, last)
        );
        if alone.elapsed > 0 {
            assert_settled(alone.acrobot.state(), alone.acrobot.params());
        }
    }
    let mut columns = [(); 6].map(|()| vec![UNTOUCHED; len]);
    let seen = batch.observe(Observations::Columns(
        columns.each_mut().map(Vec::as_mut_slice),
    ));
    assert!(seen.is_ok());
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(
            columns.each_ref().map(|column| column[index].to_bits()),
            row.map(f32::to_bits)
        );
    }
    Ok(())
}
