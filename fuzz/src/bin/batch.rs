//! A batch of any length, block size and settings is bit-identical to single acrobots.

#![no_main]

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::batch::{Autoreset, Batch, Block, Member, Observations, SimdLevel, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::ResetBounds;
use acrobot::{Acrobot, Error, Fast, Params, Portable, ResetOptions, State, Step};
use acrobot_fuzz::{assert_settled, bits, number, params, state};
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

type Many<A, const N: usize> = Batch<A, Vec<Block<A, N>>, Vec<Pcg64>, N>;

/// A single acrobot that follows the rules of a batch.
struct Alone<A: Arithmetic> {
    acrobot: Acrobot<A>,
    elapsed: u32,
    ended: bool,
}

/// What a step returns for one acrobot. The last is the final observation of an episode that the step reset.
type Returned = ([f32; 6], f32, bool, bool, Option<[f32; 6]>);

impl<A: Arithmetic> Alone<A> {
    /// Stops waiting for a reset, except in mode `NextStep`.
    fn settle(&mut self, settings: &Settings) {
        match settings.autoreset {
            Autoreset::SameStep if self.ended => self.reset(settings.bounds),
            Autoreset::Disabled => self.ended = false,
            _ => {}
        }
    }

    fn reset(&mut self, bounds: ResetBounds) {
        self.acrobot.reset_with(bounds.into());
        self.begin();
    }

    fn begin(&mut self) {
        (self.elapsed, self.ended) = (0, false);
    }

    fn step(
        &mut self,
        settings: &Settings,
        step: impl FnOnce(&mut Acrobot<A>) -> std::result::Result<Step, Error>,
    ) -> std::result::Result<Returned, Error> {
        if self.ended && settings.autoreset == Autoreset::NextStep {
            // A reset ignores the action and draws no noise.
            self.reset(settings.bounds);
            let first = self.acrobot.observation().to_array();
            return Ok((first, 0.0, false, false, None));
        }
        let step = step(&mut self.acrobot)?;
        self.elapsed = self.elapsed.saturating_add(1);
        let truncated = self.elapsed >= settings.limit.get();
        self.ended = step.terminated || truncated;
        let last = step.observation.to_array();
        let resets = self.ended && settings.autoreset == Autoreset::SameStep;
        self.settle(settings);
        Ok((
            self.acrobot.observation().to_array(),
            step.reward,
            step.terminated,
            truncated,
            resets.then_some(last),
        ))
    }

    fn member(&self) -> Member<A> {
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
    bounds: ResetBounds,
    limit: NonZeroU32,
}

fn sequence<A: Arithmetic, const N: usize>(u: &mut Unstructured<'_>) -> Result<()> {
    let len: usize = u.int_in_range(1..=35)?;
    let seed = u.arbitrary::<u64>()?;
    let blocks = vec![Block::EMPTY; len.div_ceil(N)];
    let batch = Many::<A, N>::new(seed, blocks, vec![Pcg64::UNSEEDED; len]);
    let mut batch = batch.expect("it has a block for each N");
    let mut alone: Vec<_> = SeedSequence::new(seed)
        .spawn(len as u64)
        .map(|seed| Alone {
            acrobot: Acrobot::<A>::with_rng(seed.into()),
            elapsed: 0,
            ended: false,
        })
        .collect();
    let mut settings = Settings {
        autoreset: *u.choose(&MODES)?,
        bounds: ResetBounds::DEFAULT,
        limit: u.arbitrary()?,
    };
    batch.set_autoreset(settings.autoreset);
    batch.set_limit(settings.limit);
    let levels = [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512];
    batch.set_simd_level(*u.choose(&levels)?);
    while !u.is_empty() {
        // 241 to 245 choose rare calls. The last digit of any other byte chooses the call.
        match u.arbitrary::<u8>()? {
            241 => {
                let index = u.int_in_range(0..=len + N)?;
                let state: State<A::Scalar> = state(u)?.cast();
                let set = batch.set_state(index, state);
                assert_eq!(set.is_ok(), state.validate().is_ok() && index < len);
                if let Some(alone) = alone.get_mut(index).filter(|_| set.is_ok()) {
                    assert!(alone.acrobot.set_state(state).is_ok());
                }
            }
            242 => {
                let Ok(bounds) = ResetBounds::new(number(u, -0.1)?, number(u, 0.1)?) else {
                    continue;
                };
                let seed = u.arbitrary::<Option<u64>>()?.map(SeedSequence::new);
                match seed.clone() {
                    None => batch.reset_within(bounds),
                    seed => batch.reset_with(ResetOptions {
                        seed,
                        bounds: Some(bounds),
                    }),
                }
                for (alone, index) in alone.iter_mut().zip(0..) {
                    if let Some(seed) = &seed {
                        *alone.acrobot.rng_mut() = seed.child(index).into();
                    }
                    alone.reset(bounds);
                }
            }
            243 => {
                let bits: u64 = u.arbitrary()?;
                let found = u.int_in_range(len - 1..=len + 1)?;
                let mask: Vec<bool> = (0..found).map(|i| bits >> i & 1 == 1).collect();
                let reset = batch.reset_masked(&mask, ResetOptions::default());
                assert_eq!(reset.is_ok(), found == len);
                let each = alone.iter_mut().zip(mask).filter(|_| reset.is_ok());
                for (alone, _) in each.filter(|(_, reset)| *reset) {
                    alone.reset(settings.bounds);
                }
            }
            244 => {
                settings.autoreset = Autoreset::Disabled;
                batch.set_autoreset(settings.autoreset);
                alone.iter_mut().for_each(|alone| alone.settle(&settings));
            }
            245 => {
                let mut torques = inputs(len, u, |u| {
                    Ok(A::Scalar::from_f64(u.arbitrary::<i8>()?.into()))
                })?;
                if let Some(torque) = torques.last_mut() {
                    *torque = A::Scalar::from_f64(number(u, 1.0)?);
                }
                let valid = torques.len() == len && torques.iter().all(|torque| torque.is_finite());
                step(
                    &mut batch,
                    &mut alone,
                    &settings,
                    valid,
                    |batch, buffers| batch.step(&torques, buffers),
                    |acrobot, index| acrobot.step_torque(torques[index]),
                );
            }
            call => match call % 10 {
                0 => {
                    let params: Params<A::Scalar> = params(u)?.cast();
                    let set = batch.set_params(params);
                    for alone in &mut alone {
                        assert_eq!(alone.acrobot.set_params(params).is_ok(), set.is_ok());
                    }
                }
                1 => {
                    if let Ok(bounds) = ResetBounds::new(number(u, -0.1)?, number(u, 0.1)?) {
                        settings.bounds = bounds;
                        batch.set_reset_bounds(bounds);
                    }
                }
                2 => {
                    batch.reset();
                    for alone in &mut alone {
                        alone.reset(settings.bounds);
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
                _ => {
                    // Sometimes an action is unknown, or the last one is missing.
                    let last = *u.choose(&[0, 1, 2, 0, 1, 2, 0, 1, 2, 3, u8::MAX])?;
                    let mut actions = inputs(len, u, |u| u.int_in_range(0..=2))?;
                    if let Some(action) = actions.last_mut() {
                        *action = last;
                    }
                    let valid = actions.len() == len && actions.iter().all(|&action| action < 3);
                    step(
                        &mut batch,
                        &mut alone,
                        &settings,
                        valid,
                        |batch, buffers| batch.step(&actions, buffers),
                        |acrobot, index| Ok(acrobot.step(actions[index].try_into()?)),
                    );
                }
            },
        }
        for (index, alone) in alone.iter().enumerate() {
            let state = batch.state(index).map(bits);
            assert_eq!(state, Some(bits(alone.acrobot.state())), "acrobot {index}");
            assert_eq!(batch.member(index), Some(alone.member()), "acrobot {index}");
        }
        assert_eq!((batch.member(len), batch.state(len)), (None, None));
        assert_eq!(batch.autoreset(), settings.autoreset);
        assert_eq!(batch.reset_bounds(), settings.bounds);
    }
    Ok(())
}

/// An input for each acrobot. Sometimes the last is missing.
fn inputs<'a, T>(
    len: usize,
    u: &mut Unstructured<'a>,
    mut input: impl FnMut(&mut Unstructured<'a>) -> Result<T>,
) -> Result<Vec<T>> {
    let found = len - usize::from(u.ratio(1, 16)?);
    (0..found).map(|_| input(u)).collect()
}

fn step<A: Arithmetic, const N: usize>(
    batch: &mut Many<A, N>,
    alone: &mut [Alone<A>],
    settings: &Settings,
    valid: bool,
    step: impl FnOnce(&mut Many<A, N>, StepBuffers<'_>) -> std::result::Result<(), Error>,
    step_one: impl Fn(&mut Acrobot<A>, usize) -> std::result::Result<Step, Error>,
) {
    const UNTOUCHED: f32 = 9.0;
    let len = alone.len();
    let (mut rewards, mut terminated, mut truncated) =
        (vec![UNTOUCHED; len], vec![false; len], vec![false; len]);
    let (mut rows, mut finals) = (vec![[UNTOUCHED; 6]; len], vec![[UNTOUCHED; 6]; len]);
    let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
        .with_observations(Observations::Rows(&mut rows))
        .with_final_observations(Observations::Rows(&mut finals));
    let stepped = step(batch, buffers);
    assert_eq!(stepped.is_ok(), valid);
    if stepped.is_err() {
        assert_eq!(
            (rewards, rows),
            (vec![UNTOUCHED; len], vec![[UNTOUCHED; 6]; len])
        );
        return;
    }
    for (index, alone) in alone.iter_mut().enumerate() {
        let returned = alone.step(settings, |acrobot| step_one(acrobot, index));
        let (row, reward, goal, last, final_row) = returned.expect("a valid input");
        assert_eq!(
            rows[index].map(f32::to_bits),
            row.map(f32::to_bits),
            "acrobot {index}"
        );
        assert_eq!(
            finals[index].map(f32::to_bits),
            final_row.unwrap_or([UNTOUCHED; 6]).map(f32::to_bits),
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
}
