//! What the project's front page says of the measurements is what the stored report says.

const FRONT_PAGE: &str = include_str!("../../../README.md");
const REPORT: &str = include_str!("../../../docs/report/report.md");

/// The table about kernels: its lines as cells, the heads of the columns first.
fn kernels(page: &str) -> Vec<Vec<&str>> {
    let lines =
        page.lines().skip_while(|line| !line.starts_with("| kernel |")).take_while(|line| line.starts_with('|'));
    lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

#[test]
fn the_front_pages_table_is_the_reports() {
    let (front, report) = (kernels(FRONT_PAGE), kernels(REPORT));
    assert!(report.len() > 10 && front.len() == report.len(), "{} rows for {}", front.len(), report.len());
    // A column of the front page is one of the report's, from head to foot.
    let column = |table: &[Vec<&str>], i: usize| table.iter().map(|row| row[i].to_owned()).collect::<Vec<_>>();
    for i in 0..front[0].len() {
        let place = report[0].iter().position(|head| *head == front[0][i]);
        let place = place.unwrap_or_else(|| panic!("the report has no column {:?}", front[0][i]));
        assert_eq!(column(&front, i), column(&report, place));
    }
}

#[test]
fn what_is_said_about_trees_and_machine_is_what_the_report_says() {
    for start in ["**Trees**", "Measured "] {
        let line = |page: &'static str| page.lines().find(|line| line.starts_with(start)).expect("both pages have it");
        assert_eq!(line(FRONT_PAGE), line(REPORT));
    }
}
