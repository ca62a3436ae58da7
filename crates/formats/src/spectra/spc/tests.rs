use super::*;
#[test]
fn dump() {
    for f in std::fs::read_dir("/work/tmp/spec_samples/spc").unwrap() {
        let p = f.unwrap().path();
        if p.extension().unwrap() == "txt" { continue; }
        let all = std::fs::read(&p).unwrap();
        let order = if all.get(1) == Some(&b'L') { ByteOrder::Big } else { ByteOrder::Little };
        let bytes = Bytes { all: &all, order };
        let out = Header::read(bytes).and_then(|h| traces(bytes, &h));
        let text = match out { Err(e) => format!("error {e}\n"), Ok(t) => t.iter().map(|t| format!("{} {:?} {:?} {:e} {:e}\n", t.len(), t[0], t[t.len()-1], t.iter().map(|p| p.0).sum::<f64>(), t.iter().map(|p| p.1).sum::<f64>())).collect() };
        std::fs::write(format!("{}.txt", p.display()), text).unwrap();
    }
}
