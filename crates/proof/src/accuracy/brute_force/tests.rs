use super::*;

#[test]
fn trial() {
    let n = std::env::var("N").unwrap_or("3".into()).parse().unwrap();
    let seed = std::env::var("SEED").unwrap_or("1".into()).parse().unwrap();
    let only = std::env::var("ONLY").ok().map(|o| o.parse().unwrap());
    let report = brute_force(&BruteForcePlan { cases_per_set: n, seed, only }, &|_, _| {}).unwrap();
    for s in &report.sets {
        println!("{:70} n {} fail {} low> {} above {} far {} worst {:.2e} ({}) vanish {} proved {} unproved {} untold {} wrong {} missed {} ({:?}) solver {:.2e} (max {:.2e}) brute {:.2e}",
            s.unknown, s.cases, s.failures, s.lower_above, s.above, s.far_above, s.worst_excess, s.worst_case, s.vanishing, s.proved, s.unproved, s.error_untold, s.error_wrong, s.missed, s.missed_case, s.mean_solver_s, s.longest_solver_s, s.mean_brute_force_s);
        for f in &s.first_failures { println!("    {} {}", f.case, f.what); }
    }
}

#[test]
fn look() {
    let Ok(case) = std::env::var("ONLY") else { return };
    let case: u64 = case.parse().unwrap();
    let seed = std::env::var("SEED").unwrap_or("1".into()).parse().unwrap();
    let sets = Set::all();
    let set = sets[(case % sets.len() as u64) as usize];
    let scene = Scene::draw(&mut Draw::new(seed, case), set).unwrap();
    let answer = answer(&scene, set).unwrap();
    let Scene { bands, surroundings, state, target, alternative, unknowns, range, counting } = &scene;
    println!("{scene:#?}");
    let pair = Pair { emissivity: target, alternative, state };
    let noise = counting.as_ref().map_or(Noise::PerPhoton { photons: f64::INFINITY }, Noise::Counting);
    println!("answer {answer:?}");
    for dense in [1.0, 4.0] {
        let force = BruteForce::new(bands, surroundings, unknowns, *range).as_dense(dense);
        let found = force.nearest(pair, noise).unwrap();
        println!("brute {found:?}");
        println!("sep at answer {:e}, at brute {:e}", force.separation(pair, &answer.state, noise).to_f64(), force.separation(pair, &found.state, noise).to_f64());
    }
}
